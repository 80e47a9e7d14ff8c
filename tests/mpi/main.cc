/// @file main.cc
/// Runs all tests on every rank; what one of them prints tells the rank.
#define CATCH_CONFIG_RUNNER // Catch2 2 only
#include "support/Catch.h"

#include <mpi.h>
#include <openvdb/openvdb.h>

int main(int argc, char** argv) {
    int level = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    openvdb::initialize();
    const int failed = Catch::Session().run(argc, argv);
    MPI_Finalize();
    return failed;
}
