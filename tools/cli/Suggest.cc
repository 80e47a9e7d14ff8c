/// @file Suggest.cc
/// The edit distance by its recursion, row by row.
#include "Suggest.h"

#include <algorithm>

std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> last, row(b.size() + 1), next(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        next[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                next[j] = std::min(next[j], last[j - 2] + 1);
        }
        last = row;
        std::swap(row, next);
    }
    return row[b.size()];
}

std::string nearestWord(const std::string& word, const std::vector<std::string>& known) {
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1; // farther off is another word
    std::string nearest;
    for (const std::string& candidate : known) {
        const std::size_t distance = editDistance(word, candidate);
        if (distance >= least) continue;
        least = distance;
        nearest = candidate;
    }
    return nearest;
}
