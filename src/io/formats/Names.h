/// @file Names.h
/// Names of fields, which may hold anything, as formats can have them.
#pragma once

#include <string>

namespace vdbtet {

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

} // namespace vdbtet
