/// @file Console.h
/// The standard streams: what is printed, and that they are there.
#pragma once

#include <string>

/// Open what the caller has closed, so that no file of ours gets the number of a standard stream; writing to
/// such a stream fails as before. Before any file is opened.
void holdStandardStreams();

/// To standard output.
/// @throw vdbtet::FileError
void print(const std::string& text);

/// One line to standard error, whatever bytes are in the message.
void complain(std::string message);
