/// @file Query.h
/// One question about a file, answered by a child process, for reading a damaged file may crash.
#pragma once

#include "process/Signals.h"
#include "process/Worker.h"

#include <functional>
#include <string>

/// The child's side of any work: do it, and tell what went wrong.
/// @return the exit code
int tellErrors(const Channel& channel, const std::function<void()>& work);

/// @brief The parent's side: wait for the answer.
/// @param answer  sends one message, besides those of how far it is
/// @throw std::runtime_error what the child says against @a path, or how it died
nlohmann::json ask(const std::string& path, const Signals& signals,
                   const std::function<void(const Channel&)>& answer);
