/// @file PageData.h
/// What a report's page says, as JSON.
#pragma once

#include "Summary.h"
#include "report/Picture.h"

#include <openvdb/Grid.h>

#include <string>
#include <vector>

/// @return the smallest and the largest dihedral angle of each tet
std::vector<vdbtet::AngleRange> anglesOf(const vdbtet::TetMesh& mesh);

/// @return all figures and texts of the page, safe between the tags of a script element
std::string pageData(const CommandLine& line, const Summary& summary, const openvdb::GridBase& grid,
                     const Picture& picture, const std::vector<vdbtet::AngleRange>& angles);
