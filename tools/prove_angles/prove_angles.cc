/// @file prove_angles.cc
/// The program vdbtet_prove: proves the bounds of docs/angles.md anew.
#include "Theorems.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>

namespace {

using namespace vdbtet::proof;

const Theorem* find(const std::string& id) {
    for (const Theorem& theorem : theorems()) {
        if (theorem.id == id) return &theorem;
    }
    return nullptr;
}

/// Put what "ID=MIN", "ID=MIN,MAX", "ID=,MAX" or "13=RADIUS" says into the bounds; throws on anything else.
void readBound(const std::string& text, std::map<std::string, Bound>& bounds) {
    const CLI::ValidationError wrong("--bound", "want ID=MIN, ID=MIN,MAX or ID=,MAX, not " + text);
    const std::size_t equals = text.find('=');
    const Theorem* theorem = find(text.substr(0, equals));
    if (!theorem || equals == std::string::npos) throw wrong;
    Bound bound = theorem->bound;
    const std::string values = text.substr(equals + 1);
    const std::size_t comma = values.find(',');
    const auto read = [&](const std::string& value, double& into) {
        const char* const last = value.data() + value.size();
        const auto [end, error] = std::from_chars(value.data(), last, into);
        if (error != std::errc() || end != last) throw wrong;
    };
    if (bound.radius != 0.0) {
        read(values, bound.radius);
    } else {
        if (comma != 0) read(values.substr(0, comma), bound.min);
        if (comma != std::string::npos) read(values.substr(comma + 1), bound.max);
    }
    bounds[theorem->id] = bound;
}

std::string boundText(const Bound& bound) {
    return bound.radius != 0.0 ? fmt::format("< {}", bound.radius)
                               : fmt::format("({}, {})", bound.min, bound.max);
}

std::string attainedText(const Proof& proof, const Bound& bound) {
    if (proof.least.empty()) return "";
    const double least = proof.least[0].value, greatest = proof.greatest[0].value;
    return bound.radius != 0.0 ? fmt::format("{:.4f}", greatest)
                               : fmt::format("{:.3f}, {:.3f}", least, greatest);
}

void printAttained(const char* which, const std::vector<Attained>& attained) {
    constexpr std::size_t kShown = 2;
    for (std::size_t i = 0; i < std::min(attained.size(), kShown); ++i) {
        const Attained& one = attained[i];
        fmt::print("    {} {:.4f} at ({:.4g}, {:.4g}, {:.4g}, {:.4g}) of {}\n", which, one.value, one.at[0],
                   one.at[1], one.at[2], one.at[3], one.name);
    }
    if (attained.size() > kShown) fmt::print("    and {} more kinds\n", attained.size() - kShown);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Proves the bounds of dihedral angles by branch and bound in interval arithmetic.");
    std::vector<std::string> only, others;
    app.add_option(
           "--only", only,
           "Prove only these: " +
               [] {
                   std::string ids;
                   for (const Theorem& theorem : theorems()) ids += (ids.empty() ? "" : ", ") + theorem.id;
                   return ids;
               }())
        ->delimiter(',');
    app.add_option("--bound", others,
                   "Another bound: ID=MIN, ID=MIN,MAX or ID=,MAX in degrees, 13=RADIUS in spacings");
    std::map<std::string, Bound> bounds;
    try {
        app.parse(argc, argv);
        for (const Theorem& theorem : theorems()) bounds[theorem.id] = theorem.bound;
        for (const std::string& text : others) readBound(text, bounds);
        for (const std::string& id : only) {
            if (!find(id)) throw CLI::ValidationError("--only", "there is no " + id);
        }
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }

    bool allProved = true;
    fmt::print("{:<17} {:<46} {:<17} {:<17} {:>6} {:>7} {:>9}\n", "bound", "of", "proved", "attained",
               "kinds", "of", "boxes");
    for (const Theorem& theorem : theorems()) {
        if (!only.empty() && std::find(only.begin(), only.end(), theorem.id) == only.end()) continue;
        const Bound& bound = bounds[theorem.id];
        const Proof proof = proveTheorem(theorem, bound);
        fmt::print("{:<17} {:<46} {:<17} {:<17} {:>6} {:>7} {:>9}\n", theorem.id, theorem.what,
                   (proof.proved ? "" : "NOT ") + boundText(bound), attainedText(proof, bound), proof.kinds,
                   proof.configurations, proof.boxes);
        if (!proof.proved) fmt::print("    {}\n", proof.obstacle);
        if (bound.radius == 0.0) printAttained("least", proof.least);
        printAttained("greatest", proof.greatest);
        std::fflush(stdout);
        allProved = allProved && proof.proved;
    }
    fmt::print("{}\n", allProved ? "All of this is proved." : "Not all of this is proved.");
    return allProved ? 0 : 1;
}
