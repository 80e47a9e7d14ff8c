/// @file GridFile.h
/// Finds the grid to mesh in a .vdb file, and those whose values the mesh shall carry.
#pragma once

#include <openvdb/Grid.h>

#include <string>
#include <vector>

namespace vdbtet {

/// @brief Read one grid of a .vdb file.
/// @param path       a regular file written by OpenVDB
/// @param name       a grid's name; NAME[i] for the i-th (from 0) of several grids of that name, [i] for
///                   the i-th of the unnamed ones; empty for the file's only float or double grid, else
///                   its only level set
/// @param delayLoad  leave the leaf buffers on disk until they are touched, where this OpenVDB can
/// @throw FileError        when the file cannot be read, or the name is not in it; the message lists what is
/// @throw UnsupportedGrid  when no name is given and no single scalar grid stands out
openvdb::GridBase::Ptr readGrid(const std::string& path, const std::string& name = {},
                                bool delayLoad = false);

/// What a .vdb file says of one of its grids.
struct GridHead {
    std::string name;                 ///< as readGrid() takes it
    std::string type;                 ///< such as Tree_float_5_4_3
    openvdb::GridBase::ConstPtr grid; ///< its metadata and transform, and no values to rely on; null if
                                      ///< OpenVDB does not know the type
};

/// @return all grids of a .vdb file, in its order, with their trees left unread
/// @throw FileError as above
std::vector<GridHead> readHeads(const std::string& path);

/// @return the names of a .vdb file's float and double grids, in its order, as readGrid() takes them
/// @throw FileError        as above
/// @throw UnsupportedGrid  when there is none
std::vector<std::string> scalarGrids(const std::string& path);

/// @brief Read the grids of a .vdb file whose values a mesh shall carry.
/// @param names  as above; or empty for all that FieldSampler can sample but the grid named @a except
/// @param delayLoad  as above: only what is sampled is read
/// @throw FileError as above
std::vector<openvdb::GridBase::ConstPtr> readFields(const std::string& path,
                                                    const std::vector<std::string>& names,
                                                    const std::string& except = {}, bool delayLoad = false);

/// @brief Read what a .vdb file says of itself, such as who made it.
/// @throw FileError as above
openvdb::MetaMap readFileMetadata(const std::string& path);

} // namespace vdbtet
