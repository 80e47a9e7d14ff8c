/// @file Names.h
/// Names of fields, which may hold anything, as formats can have them.
#pragma once

#include <set>
#include <string>

namespace vdbtet {

/// Tells names apart that became one.
class UniqueNames {
public:
    /// @return @a name, with as many "_" behind it as it takes to be a new one
    std::string operator()(std::string name) {
        while (!mTaken.insert(name).second) name += "_";
        return name;
    }

private:
    std::set<std::string> mTaken;
};

/// @return @a name as an attribute's value in XML
inline std::string xmlName(const std::string& name) {
    std::string result;
    for (const char c : name) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += static_cast<unsigned char>(c) < ' ' ? '?' : c; // XML has no such characters
        }
    }
    return result;
}

/// @return @a name without spaces, in the way legacy VTK has them: as %20
inline std::string percentName(const std::string& name) {
    constexpr char kDigits[] = "0123456789ABCDEF";
    std::string result;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte <= ' ' || c == '%' || c == '"' || byte == 0x7f) {
            result += '%';
            result += kDigits[byte >> 4];
            result += kDigits[byte & 15];
        } else {
            result += c;
        }
    }
    return result;
}

/// @return @a name as a name of a file
inline std::string fileName(const std::string& name) {
    std::string result;
    for (const char c : name)
        result += c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
    return result;
}

/// @return @a name in the quotes that Gmsh has around names
inline std::string quotedName(const std::string& name) {
    std::string result = "\"";
    for (const char c : name) result += static_cast<unsigned char>(c) < ' ' ? '?' : c == '"' ? '\'' : c;
    return result + "\"";
}

/// @return @a name as an identifier of letters, digits and "_", as USD and Houdini want it
inline std::string identifier(const std::string& name) {
    std::string result;
    for (const char c : name) {
        const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        result += fits ? c : '_';
    }
    return result.empty() || (result[0] >= '0' && result[0] <= '9') ? "_" + result : result;
}

} // namespace vdbtet
