/// @file Seams.h
/// What the parts of a mesh tell each other while a stage works.
#pragma once

#include "tiles/Bytes.h"
#include "tiles/Layout.h"

#include <cstdint>
#include <functional>

namespace vdbtet {

/// @brief The seams of a part with all others; as they are here, those of a mesh in one piece, which has
/// none.
/// @details A part makes the records of its own tiles, and gets those of the tiles that it has borrowed (see
/// Layout) from the parts that made them. All members are called by all parts alike, and by one thread.
class Seams {
public:
    using Pack = std::function<void(TileRef, Bytes&)>;
    using Unpack = std::function<void(TileRef, Unpacker&)>;

    virtual ~Seams() = default;

    /// Send the records of our tiles that others have borrowed, and get those that we have.
    /// @param unpack  called in ascending order of the tiles' references
    virtual void exchange(const Pack& pack, const Unpack& unpack) const;

    /// Of a record of one size for each tile.
    template <typename Records>
    void exchange(Records& records) const {
        exchange([&](TileRef t, Bytes& bytes) { pack(bytes, records[std::size_t(t)]); },
                 [&](TileRef t, Unpacker& next) { next(&records[std::size_t(t)], 1); });
    }

    /// Each part may have marked vertices of borrowed tiles, too: make each tile's mask what any part has
    /// marked.
    virtual void unite(VertexMasks& masks) const;

    /// Do work that is this part's alone; what it throws in one part, all throw.
    virtual void together(const std::function<void()>& work) const;

    /// Make a number the sum of all parts'.
    virtual void sum(std::int64_t& value) const;
    virtual bool any(bool value) const;
};

} // namespace vdbtet
