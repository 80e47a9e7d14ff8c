/// @file Seams.cc
/// A mesh in one piece.
#include "tiles/Seams.h"

namespace vdbtet {

void Seams::exchange(const Pack&, const Unpack&) const {}

void Seams::unite(VertexMasks&) const {}

void Seams::together(const std::function<void()>& work) const { work(); }

void Seams::sum(std::int64_t&) const {}

bool Seams::any(bool value) const { return value; }

} // namespace vdbtet
