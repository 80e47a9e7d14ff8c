/// @file Suggest.h
/// What somebody who mistyped a word most likely meant.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// @return how many letters must be put in, taken out, changed, or swapped with the next, to make @a b of
/// @a a (optimal string alignment)
std::size_t editDistance(const std::string& a, const std::string& b);

/// @return the word of @a known that is nearest, the first of several; empty where none is near
std::string nearestWord(const std::string& word, const std::vector<std::string>& known);
