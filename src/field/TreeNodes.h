/// @file TreeNodes.h
/// The constant tiles of a tree, node by node.
#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace vdbtet {

/// The nodes above the leaves, whose tiles are as large as a leaf or as the node below.
template <typename TreeT>
struct TreeNodes {
    using UpperT = typename TreeT::RootNodeType::ChildNodeType;
    using LowerT = typename UpperT::ChildNodeType;

    explicit TreeNodes(const TreeT& tree) {
        tree.getNodes(lower);
        tree.getNodes(upper);
    }

    std::vector<const LowerT*> lower;
    std::vector<const UpperT*> upper;
};

/// @brief Call @a visit(value, slot) for each tile of a node; node.offsetToGlobalCoord(slot) is its place.
/// @details A node has up to 32768 of them: its iterators would take longer than the leaves do.
template <typename NodeT, typename Visit>
void forEachTile(const NodeT& node, Visit&& visit) {
    for (openvdb::Index slot = 0; slot < NodeT::NUM_VALUES; ++slot) {
        if (!node.isChildMaskOn(slot)) visit(node.getTable()[slot].getValue(), slot);
    }
}

} // namespace vdbtet
