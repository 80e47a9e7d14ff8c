/// @file main.cc
/// Runs all tests.
#define CATCH_CONFIG_RUNNER // Catch2 2 only
#include "support/Catch.h"

#include <openvdb/openvdb.h>

int main(int argc, char** argv) {
    openvdb::initialize();
    return Catch::Session().run(argc, argv);
}
