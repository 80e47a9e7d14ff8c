/// @file Query.cc
/// Waits for the child's message, or a signal.
#include "process/Query.h"

#include "batch/Outcome.h"

#include <vdbtet/Errors.h>

#include <poll.h>

#include <new>
#include <stdexcept>

int tellErrors(const Channel& channel, const std::function<void()>& work) {
    const auto fail = [&](const char* message, int code) {
        channel.send({{"error", message}, {"code", code}});
        return code;
    };
    try {
        work();
        return 0;
    } catch (const vdbtet::BadOption& error) {
        return fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return fail("memory ran out; use a coarser --spacing, or fewer --jobs", 1);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}

nlohmann::json ask(const std::string& path, const Signals& signals,
                   const std::function<void(const Channel&)>& answer) {
    nlohmann::json message;
    Worker worker(signals,
                  [&](const Channel& channel) { return tellErrors(channel, [&] { answer(channel); }); });
    do {
        pollfd file = {worker.fd(), POLLIN, 0};
        ::ppoll(&file, 1, nullptr, &signals.whileWaiting());
        signals.check();
        if (signals.first() != 0) throw std::runtime_error("interrupted"); // which kills the child
    } while (worker.receive([&](const nlohmann::json& received) {
        if (!received.contains("stage")) message = received; // on the way, and no answer
    }));
    if (message.is_null()) throw std::runtime_error(epitaph(path, "read", worker.end()));
    if (message.contains("error")) throw std::runtime_error(message["error"].get<std::string>());
    return message;
}
