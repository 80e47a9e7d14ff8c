/// @file Console.cc
/// Through stdio, and flushed at once.
#include "Console.h"

#include <vdbtet/Errors.h>

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

void holdStandardStreams() {
    for (int fd = 0; fd <= 2; ++fd) {
        // open() takes the lowest number that is free.
        if (::fcntl(fd, F_GETFD) < 0 && ::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) != fd) return;
    }
}

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw vdbtet::FileError("cannot write to standard output");
    }
}

void complain(std::string message) {
    // Names of files and grids may hold anything; an error is one line all the same.
    for (char& c : message) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    }
    std::fputs(("vdb_tet: " + message + "\n").c_str(), stderr);
}
