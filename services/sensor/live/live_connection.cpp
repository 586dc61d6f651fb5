// SPDX-License-Identifier: Apache-2.0
#include "services/sensor/live/live_connection.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <future>
#include <string_view>
#include <thread>
#include <utility>

namespace pursuit::sensor {
namespace {

constexpr std::string_view tcp_scheme = "tcp://";
constexpr std::chrono::milliseconds connect_time{2000};
constexpr std::chrono::milliseconds stop_check_time{50};
constexpr std::chrono::milliseconds for_ever{-1};

class Descriptor final : public ByteSource {
 public:
    Descriptor(std::string name, int file, const StopSignal& stop)
        : name_(std::move(name)), file_(file), stop_(stop) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() override { ::close(file_); }

    const std::string& name() const override { return name_; }
    int file() const { return file_; }

    Result<std::size_t> read(std::span<std::uint8_t> bytes) override {
        for (;;) {
            if (!stop_.wait(file_, POLLIN, for_ever)) return 0;
            const auto n = ::read(file_, bytes.data(), bytes.size());
            if (n >= 0) return static_cast<std::size_t>(n);
            if (errno != EINTR && errno != EAGAIN) {
                return fail(name_ + ": cannot read: " + std::strerror(errno));
            }
        }
    }

 private:
    std::string name_;
    int file_;
    const StopSignal& stop_;
};

Result<std::unique_ptr<ByteSource>> open_path(const LiveAddress& address, const StopSignal& stop) {
    const auto& path = address.text;
    const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return fail(path + ": cannot open: " + std::strerror(errno));
    auto source = std::make_unique<Descriptor>(path, file, stop);
    struct stat facts {};
    if (::fstat(file, &facts) != 0) return fail(path + ": " + std::strerror(errno));
    if (S_ISREG(facts.st_mode) || S_ISDIR(facts.st_mode)) {
        return fail(path + ": is neither FIFO nor device; a file of events is a recording");
    }
    termios settings{};
    if (::tcgetattr(file, &settings) == 0) {
        ::cfmakeraw(&settings);
        if (::tcsetattr(file, TCSANOW, &settings) != 0) {
            return fail(path + ": cannot set up the terminal: " + std::strerror(errno));
        }
    }
    return source;
}

Result<std::unique_ptr<ByteSource>> open_standard_input(const LiveAddress& address,
                                                        const StopSignal& stop) {
    // A copy, so that closing it leaves descriptor 0 alone; its flags too: others may share it, and
    // a read that follows a successful poll does not block.
    const int file = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    if (file < 0) return fail("standard input: " + std::string(std::strerror(errno)));
    return std::make_unique<Descriptor>(address.text, file, stop);
}

/// Connects `file` within connect_time; an error as errno's number, 0 for none.
int connect_within(int file, const addrinfo& to, const StopSignal& stop) {
    if (::connect(file, to.ai_addr, to.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    if (!stop.wait(file, POLLOUT, connect_time)) return ETIMEDOUT;
    int error = 0;
    socklen_t size = sizeof error;
    return ::getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

void keep_alive(int file) {
    const auto set = [file](int level, int name, int value) {
        // Without it a dead peer is noticed later; the stream itself does not suffer.
        [[maybe_unused]] const int done = ::setsockopt(file, level, name, &value, sizeof value);
    };
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 5);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
    set(IPPROTO_TCP, TCP_KEEPCNT, 3);
}

using Found = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

/// What a name stands for. The resolver cannot be interrupted and may take half a minute: it works
/// on a thread of its own, which is left behind when `stop` is raised.
Result<Found> look_up(const LiveAddress& address, const StopSignal& stop) {
    std::packaged_task<Result<Found>()> task([address]() -> Result<Found> {
        addrinfo wanted{};
        wanted.ai_socktype = SOCK_STREAM;
        addrinfo* found = nullptr;
        const int error =
            ::getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
        if (error != 0) return fail(address.text + ": " + ::gai_strerror(error));
        return Found(found, ::freeaddrinfo);
    });
    auto found = task.get_future();
    std::thread(std::move(task)).detach();
    while (found.wait_for(stop_check_time) != std::future_status::ready) {
        if (stop.raised()) return fail(address.text + ": stopped");
    }
    return found.get();
}

Result<std::unique_ptr<ByteSource>> connect_tcp(const LiveAddress& address,
                                                const StopSignal& stop) {
    const auto found = look_up(address, stop);
    if (!found) return tl::unexpected(found.error());
    int error = ENOENT;
    for (const auto* to = found->get(); to != nullptr && !stop.raised(); to = to->ai_next) {
        const int file = ::socket(to->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (file < 0) {
            error = errno;
            continue;
        }
        auto source = std::make_unique<Descriptor>(address.text, file, stop);
        error = connect_within(file, *to, stop);
        if (error != 0) continue;
        keep_alive(file);
        return source;
    }
    return fail(address.text + ": cannot connect: " + std::strerror(error));
}

}  // namespace

Result<LiveAddress> parse_live_address(const std::string& text) {
    LiveAddress address;
    address.text = text;
    if (text == "-") {
        address.kind = LiveAddress::Kind::standard_input;
        return address;
    }
    if (!text.starts_with(tcp_scheme)) {
        if (text.find("://") != std::string::npos) {
            return fail("\"" + text + "\" is neither -, nor tcp://host:port, nor a path");
        }
        return address;
    }
    address.kind = LiveAddress::Kind::tcp;
    const auto rest = text.substr(tcp_scheme.size());
    const auto colon = rest.rfind(':');
    address.host = rest.substr(0, colon);
    address.port = colon == std::string::npos ? "" : rest.substr(colon + 1);
    if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']') {
        address.host = address.host.substr(1, address.host.size() - 2);
    }
    std::uint16_t port = 0;
    const auto* end = address.port.data() + address.port.size();
    const auto parsed = std::from_chars(address.port.data(), end, port);
    if (address.host.empty() || parsed.ec != std::errc() || parsed.ptr != end || port == 0) {
        return fail("\"" + text + "\" is not tcp://host:port with a port of 1 to 65535");
    }
    return address;
}

Result<std::unique_ptr<ByteSource>> connect_live(const LiveAddress& address,
                                                 const StopSignal& stop) {
    switch (address.kind) {
        case LiveAddress::Kind::standard_input:
            return open_standard_input(address, stop);
        case LiveAddress::Kind::tcp:
            return connect_tcp(address, stop);
        case LiveAddress::Kind::path:
            break;
    }
    return open_path(address, stop);
}

}  // namespace pursuit::sensor
