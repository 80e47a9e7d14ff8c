/// @file MeshJob.h
/// What a child process does: read, mesh into a sink, tell.
///
/// Messages to the parent are objects. On the way: {stage, percent, tets}, or {warning}, a line. At the end
/// one of {done}, of what the job came to; {error, code}, of a line and an exit code; {cancelled}, of a
/// signal.
#pragma once

#include "CommandLine.h"
#include "process/Worker.h"

/// Mesh one grid of one file.
/// @return an exit code; all else goes through the channel
int meshJob(const CommandLine& line, const Channel& channel);
