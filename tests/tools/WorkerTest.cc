// Child processes and what they tell.
#include "support/Catch.h"

#include "process/Worker.h"

#include <unistd.h>

#include <csignal>

#include <string>
#include <vector>

namespace {

/// @return the child's messages, once it has ended
std::vector<nlohmann::json> messagesOf(Worker& worker) {
    std::vector<nlohmann::json> messages;
    while (worker.receive([&](const nlohmann::json& message) { messages.push_back(message); })) {
    }
    return messages;
}

} // namespace

TEST_CASE("a child's messages arrive whole and in order, of any size and any bytes") {
    const Signals signals;
    const std::string large(300000, 'x'), odd = "caf\xe9 \xff";
    Worker worker(signals, [&](const Channel& channel) {
        channel.send({{"n", 1}});
        channel.send({{"large", large}});
        channel.send({{"odd", odd}});
        return 7;
    });
    const auto messages = messagesOf(worker);
    REQUIRE(messages.size() == 3);
    CHECK(messages[0]["n"] == 1);
    CHECK(messages[1]["large"] == large);
    CHECK(messages[2]["odd"].get<std::string>() == odd);
    CHECK(worker.end().code == 7);
    CHECK(worker.end().signal == 0);
    CHECK(worker.end().peakMemory > 0);
}

TEST_CASE("what a child has told counts when it is killed") {
    const Signals signals;
    Worker worker(signals, [&](const Channel& channel) {
        channel.send({{"n", 1}});
        for (;;) ::pause();
        return 0;
    });
    std::vector<nlohmann::json> messages;
    while (worker.receive([&](const nlohmann::json& message) {
        messages.push_back(message);
        worker.signal(SIGKILL);
    })) {
    }
    CHECK(messages.size() == 1);
    CHECK(worker.end().signal == SIGKILL);
}

TEST_CASE("a child is gone with its owner") {
    const Signals signals;
    pid_t pid = 0;
    {
        const Worker worker(signals, [](const Channel&) {
            for (;;) ::pause();
            return 0;
        });
        pid = worker.pid();
        CHECK(::kill(pid, 0) == 0);
    }
    CHECK(::kill(pid, 0) != 0);
}
