/// @file Moves.cc
/// Numbers by count and scan.
#include "destinations/Moves.h"

namespace vdbtet {

std::int64_t Moves::number() {
    std::int64_t sum = 0;
    first.resize(moved.size() + 1);
    for (std::size_t t = 0; t < moved.size(); ++t) {
        for (int lattice = 0; lattice < 2; ++lattice) {
            first[t][lattice] = sum;
            sum += moved[t][lattice].count();
        }
    }
    first.back() = {sum, sum};
    return sum;
}

} // namespace vdbtet
