/// @file Frames.cc
/// Parsing by regular expressions, but for what may be long: they recurse.
#include "batch/Frames.h"

#include "UsageError.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace {

constexpr std::size_t kMostFrames = 100000;

/// Where the file's name begins.
std::size_t nameStart(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? 0 : slash + 1;
}

} // namespace

std::vector<std::int64_t> parseFrames(const std::string& list) {
    static const std::regex kItem("(-?[0-9]{1,15})(?:-(-?[0-9]{1,15})(?:x([0-9]{1,15}))?)?");
    std::vector<std::int64_t> frames;
    std::set<std::int64_t> seen;
    std::istringstream items(list + ",");
    for (std::string item; std::getline(items, item, ',');) {
        std::smatch match;
        if (!std::regex_match(item, match, kItem)) {
            throw UsageError(
                fmt::format("--frames: '{}' is neither a frame nor a range, such as 1-240 or 1-240x2", item));
        }
        const std::int64_t first = std::stoll(match[1]);
        const std::int64_t last = match[2].matched ? std::stoll(match[2]) : first;
        const std::int64_t step = match[3].matched ? std::stoll(match[3]) : 1;
        if (last < first || step < 1)
            throw UsageError(fmt::format("--frames: the range '{}' has no frames", item));
        for (std::int64_t frame = first; frame <= last; frame += step) {
            if (seen.size() == kMostFrames)
                throw UsageError(fmt::format("--frames: more than {} frames", kMostFrames));
            if (seen.insert(frame).second) frames.push_back(frame);
        }
    }
    return frames;
}

std::optional<FramePattern> FramePattern::find(const std::string& path) {
    const auto at = [&](std::size_t i) { return i < path.size() ? path[i] : '\0'; };
    std::optional<FramePattern> found;
    for (std::size_t i = nameStart(path), end; i < path.size(); i = end) {
        end = i + 1;
        int digits = 1;
        if (path[i] == '#') {
            while (at(end) == '#') ++end;
            digits = int(end - i);
        } else if (path[i] == '%') {
            std::size_t next = i + 1;
            if (at(next) == '0' && at(next + 1) != 'd') ++next;
            if (at(next) >= '1' && at(next) <= '9') digits = at(next++) - '0';
            if (at(next) != 'd') continue;
            end = next + 1;
        } else {
            continue;
        }
        found.emplace();
        found->mBefore = path.substr(0, i);
        found->mAfter = path.substr(end);
        found->mDigits = digits;
    }
    return found;
}

std::string FramePattern::number(std::int64_t frame) const { return fmt::format("{:0{}}", frame, mDigits); }

std::optional<std::string> lastNumber(const std::string& name) {
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    const auto end = std::find_if(name.rbegin(), name.rend(), isDigit);
    if (end == name.rend()) return std::nullopt;
    return std::string(std::find_if_not(end, name.rend(), isDigit).base(), end.base());
}

std::string fillIn(const std::string& pattern, const Placeholders& values, const std::string& option) {
    static const std::regex kPlaceholder("\\{(stem|frame|grid)\\}");
    std::string result;
    auto rest = pattern.cbegin();
    for (auto match = std::sregex_iterator(pattern.begin(), pattern.end(), kPlaceholder);
         match != std::sregex_iterator(); ++match) {
        const std::string name = (*match)[1];
        if (name == "frame" && !values.frame) {
            throw UsageError(
                fmt::format("{} has {{frame}}, but {} has no number in its name", option, values.stem));
        }
        if (name == "grid" && !values.grid) {
            throw UsageError(fmt::format(
                "{} has {{grid}}, which stands for a grid only with --all-grids or --name", option));
        }
        result.append(rest, (*match)[0].first);
        result += name == "stem" ? values.stem : name == "frame" ? *values.frame : *values.grid;
        rest = (*match)[0].second;
    }
    return result.append(rest, pattern.cend());
}
