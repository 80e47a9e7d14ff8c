/// @file Fields.cc
/// Grids by name, of IN or of another file.
#include "Fields.h"

#include <vdbtet/GridFile.h>

#include <vector>

namespace {

/// The grids of a list of names.
std::vector<openvdb::GridBase::ConstPtr> gridsOf(const std::vector<std::string>& names,
                                                 const CommandLine& line, const std::string& meshed,
                                                 bool delayLoad) {
    if (names.empty()) return {};
    const bool elsewhere = !line.fieldsFrom.empty();
    const bool all = names.size() == 1 && names[0] == "all";
    return vdbtet::readFields(elsewhere ? line.fieldsFrom : line.in, all ? std::vector<std::string>() : names,
                              elsewhere ? std::string() : meshed, delayLoad);
}

} // namespace

vdbtet::FieldOptions readFields(const CommandLine& line, const std::string& meshed, bool delayLoad) {
    vdbtet::FieldOptions fields;
    fields.pointGrids = gridsOf(line.sample, line, meshed, delayLoad);
    fields.cellGrids = line.sampleCells == line.sample ? fields.pointGrids
                                                       : gridsOf(line.sampleCells, line, meshed, delayLoad);
    fields.boundaryFlag = line.boundaryFlag;
    fields.minDihedral = line.minDihedral;
    return fields;
}
