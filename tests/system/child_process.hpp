// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace pursuit::testing {

/// Waits up to 10 s for `condition`.
inline bool eventually(const std::function<bool()>& condition) {
    for (int i = 0; i < 2000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

/// One of the built programs, run by a test; killed with it. Its standard error goes to a file.
class ChildProcess {
 public:
    /// `prepare` runs in the child before the program does.
    ChildProcess(
        const std::string& name, const std::vector<std::string>& arguments,
        const std::string& log_path, const std::function<void()>& prepare = [] {})
        : log_path_(log_path) {
        const char* folder = std::getenv("PURSUIT_BIN");
        const std::string program = std::string(folder ? folder : "build/release/bin") + "/" + name;
        std::vector<char*> argv{const_cast<char*>(program.c_str())};
        for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ < 0) throw std::runtime_error("cannot fork");
        if (pid_ > 0) return;
        const int log = ::open(log_path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
        ::dup2(log, STDERR_FILENO);
        prepare();
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
    ~ChildProcess() {
        if (!code_) {
            ::kill(pid_, SIGCONT);
            ::kill(pid_, SIGKILL);
            wait();
        }
    }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void signal(int number) { ::kill(pid_, number); }
    pid_t pid() const { return pid_; }

    bool running() {
        if (code_) return false;
        int status = 0;
        if (::waitpid(pid_, &status, WNOHANG) == pid_) keep(status);
        return !code_;
    }

    /// The exit code, or minus the signal that ended it.
    int wait() {
        int status = 0;
        if (!code_ && ::waitpid(pid_, &status, 0) == pid_) keep(status);
        return *code_;
    }

    /// SIGTERM; how long it took to end.
    std::chrono::milliseconds stop() {
        const auto begin = std::chrono::steady_clock::now();
        signal(SIGTERM);
        wait();
        return std::chrono::duration_cast<std::chrono::milliseconds>(
            std::chrono::steady_clock::now() - begin);
    }

    std::string log() const {
        std::ostringstream text;
        text << std::ifstream(log_path_).rdbuf();
        return text.str();
    }

 private:
    void keep(int status) { code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status); }

    std::string log_path_;
    pid_t pid_ = -1;
    std::optional<int> code_;
};

}  // namespace pursuit::testing
