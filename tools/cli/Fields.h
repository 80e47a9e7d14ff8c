/// @file Fields.h
/// The fields that the command line asks for.
#pragma once

#include "CommandLine.h"

#include <vdbtet/FieldSampler.h>

#include <string>

/// @return all of them but the distance, with the grids read
/// @param meshed     the name of the grid that is meshed
/// @param delayLoad  read only what is sampled, where this OpenVDB can
/// @throw vdbtet::FileError
vdbtet::FieldOptions readFields(const CommandLine& line, const std::string& meshed, bool delayLoad = false);
