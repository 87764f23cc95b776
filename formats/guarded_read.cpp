// SPDX-License-Identifier: Apache-2.0
#include "formats/guarded_read.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "formats/error.h"

namespace opal {
namespace {

constexpr int crash_signals[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};

/// A crash leaves neither a file of memory nor words of a library's insides behind.
void crash_in_silence() {
    // Where this process is ended while it waits, so is its child.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit none = {0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
        ::dup2(nowhere, STDOUT_FILENO);
        ::dup2(nowhere, STDERR_FILENO);
    }
    for (const int signal : crash_signals) std::signal(signal, SIG_DFL);
}

}  // namespace

void require_no_crash(const std::filesystem::path& path, const std::function<void()>& read) {
    const pid_t child = ::fork();
    if (child < 0) throw SystemError(fmt::format("{}: no process to check it in: {}", path.string(), std::strerror(errno)));
    if (child == 0) {
        crash_in_silence();
        try {
            read();
        } catch (...) {
        }
        // Not through exit(): libraries wait there for threads that this process has not got.
        std::_Exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    // It ends with 0 itself; what watches over memory (a sanitizer) ends it with something else.
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (!WIFSIGNALED(status))
        throw InputError(
            fmt::format("{}: not a complete .vdb file, or a damaged one: reading it writes where it must not", path.string()));
    for (const int signal : crash_signals)
        if (WTERMSIG(status) == signal)
            throw InputError(fmt::format("{}: not a complete .vdb file, or a damaged one: reading it ends with a crash ({})",
                                         path.string(), ::strsignal(signal)));
    throw InputError(fmt::format("{}: cannot be read: the process that checked it was ended ({}); is it larger than memory?",
                                 path.string(), ::strsignal(WTERMSIG(status))));
}

}  // namespace opal
