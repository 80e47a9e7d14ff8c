/// @file Manual.h
/// What vdb_tet tells of its options: --help, the man page and completion in shells, all from the option
/// table.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

/// The most used options, a line each, and examples: what fits on a screen.
std::string helpScreen(const CLI::App& app);

/// The man page, in troff.
std::string manPage(const CLI::App& app);

/// @return a script to complete options and their values with.
/// @param shell  bash, zsh or fish
std::string completion(const CLI::App& app, const std::string& shell);
