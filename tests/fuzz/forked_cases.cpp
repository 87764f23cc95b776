// SPDX-License-Identifier: GPL-3.0-or-later
#include "forked_cases.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include "seed_files.h"

namespace opal::fuzz {
namespace {

constexpr std::size_t num_kinds = 13;
constexpr std::uint64_t cases_per_process = 200;
/// What a process's first cases of a kind leave on the heap are tables that are made once.
constexpr int warm_up_cases = 3;

struct KindCounts {
    std::uint64_t run, results, refused, defects, measured;
    double heap_bytes;  ///< left by `measured` cases
};

/// What the processes share.
struct Board {
    std::uint64_t current;  ///< the case that is running
    std::array<KindCounts, num_kinds> kinds;
    double lost_paths, paths;
};

class WorkFolder {
  public:
    WorkFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "opal_fuzz_XXXXXX").string();
        if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~WorkFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

Board* shared_board() {
    void* const memory = ::mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
    return new (memory) Board();
}

/// Runs `work` in a process of its own; returns what waitpid says.
int in_child(const std::function<void()>& work) {
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) {
        try {
            work();
        } catch (const std::exception& error) {
            fmt::print("in the harness: {}\n", error.what());
            std::fflush(stdout);
            std::_Exit(1);
        }
#if defined(__SANITIZE_ADDRESS__)
        __lsan_do_leak_check();
#endif
        // Not through exit(): libraries wait there for threads that this process has not got.
        std::fflush(stdout);
        std::_Exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0) {
    }
    return status;
}

void limit_memory(double gigabytes) {
#if defined(__SANITIZE_ADDRESS__)
    (void)gigabytes;  // shadow memory takes terabytes of addresses
#else
    const rlimit limit = {rlim_t(gigabytes * 1.0e9), rlim_t(gigabytes * 1.0e9)};
    ::setrlimit(RLIMIT_AS, &limit);
#endif
}

/// The process is killed by a signal where the time runs out, by its own work or by the clock.
void allow_time(double cpu_s) {
    itimerval timer = {};
    timer.it_value.tv_sec = time_t(cpu_s);
    timer.it_value.tv_usec = suseconds_t(std::fmod(cpu_s, 1.0) * 1.0e6);
    ::setitimer(ITIMER_PROF, &timer, nullptr);
    ::alarm(unsigned(10.0 * cpu_s));
}

class CaseRunner {
  public:
    CaseRunner(const FuzzOptions& options, const std::filesystem::path& folder, Board& board)
        : options_(options), folder_(folder), board_(board) {}

    Kind kind(std::uint64_t index) const { return options_.only.value_or(kind_of(options_.lane, index)); }

    /// In a process of its own.
    void run(std::uint64_t first, std::uint64_t end) const {
        limit_memory(options_.memory_limit_gb);
        std::array<int, num_kinds> seen = {};
        for (std::uint64_t index = first; index < end; ++index) {
            board_.current = index;
            remove_case_files(folder_);
            allow_time(options_.cpu_limit_s);
            const double before = double(::mallinfo2().uordblks);
            CaseOutcome outcome;
            try {
                outcome = run_case(folder_, kind(index), options_.seed, index);
            } catch (const std::exception& error) {
                outcome.defect = std::string("the case could not be run: ") + error.what();
            }
            allow_time(0.0);
            if (!outcome.defect.empty()) tell(index, outcome.defect);
            const bool warm = ++seen[std::size_t(kind(index))] > warm_up_cases;
            count(outcome, index, warm ? std::optional(double(::mallinfo2().uordblks) - before) : std::nullopt);
        }
    }

    /// A case that went wrong: says so and keeps its files.
    void tell(std::uint64_t index, const std::string& defect) const {
        const std::string& name = kind_names()[std::size_t(kind(index))];
        fmt::print("DEFECT {} case {} seed {}: {}\n", name, index, options_.seed, defect);
        std::fflush(stdout);
        if (options_.keep.empty()) return;
        std::filesystem::create_directories(options_.keep);
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            if (const std::string file = entry.path().filename().string(); file.starts_with("case."))
                std::filesystem::copy_file(entry.path(), options_.keep / fmt::format("{}_{}_{}", name, index, file),
                                           std::filesystem::copy_options::overwrite_existing);
    }

    /// `heap_bytes`: what the case left on the heap, where that is known.
    void count(const CaseOutcome& outcome, std::uint64_t index, const std::optional<double>& heap_bytes) const {
        KindCounts& counts = board_.kinds[std::size_t(kind(index))];
        ++counts.run;
        ++(!outcome.defect.empty() ? counts.defects : outcome.refused ? counts.refused : counts.results);
        board_.lost_paths += outcome.lost_paths;
        board_.paths += outcome.paths;
        if (!heap_bytes) return;
        ++counts.measured;
        counts.heap_bytes += *heap_bytes;
    }

  private:
    const FuzzOptions& options_;
    const std::filesystem::path folder_;
    Board& board_;
};

std::string how_it_ended(int status) {
    if (!WIFSIGNALED(status)) return fmt::format("the process ended with {}", WEXITSTATUS(status));
    const int signal = WTERMSIG(status);
    if (signal == SIGPROF || signal == SIGALRM) return "took too long";
    return fmt::format("killed by signal {} ({})", signal, ::strsignal(signal));
}

void print_summary(const Board& board) {
    fmt::print("{:12} {:>8} {:>8} {:>8} {:>8} {:>22}\n", "kind", "cases", "results", "refused", "defects",
               "heap left per case, kB");
    for (std::size_t k = 0; k < num_kinds; ++k) {
        const KindCounts& counts = board.kinds[k];
        if (counts.run == 0) continue;
        fmt::print("{:12} {:8} {:8} {:8} {:8} {:22.2f}\n", kind_names()[k], counts.run, counts.results, counts.refused,
                   counts.defects, 1.0e-3 * counts.heap_bytes / double(std::max<std::uint64_t>(1, counts.measured)));
    }
    if (board.paths > 0.0) fmt::print("paths {:.0f}, lost {:.0f}\n", board.paths, board.lost_paths);
}

}  // namespace

FuzzSummary run_forked(const FuzzOptions& options) {
    const WorkFolder folder;
    Board& board = *shared_board();
    // Nothing of the libraries' threads may live in this process when it forks.
    const auto make_seeds = [&] {
        allow_time(30.0 * options.cpu_limit_s);
        make_seed_files(folder.path());
    };
    if (const int status = in_child(make_seeds); status != 0)
        throw std::runtime_error("the seed files could not be made: " + how_it_ended(status));
    const CaseRunner runner(options, folder.path(), board);
    const std::uint64_t end = options.first + options.cases;
    for (std::uint64_t next = options.first; next < end;) {
        const std::uint64_t stop = std::min(end, next + cases_per_process);
        const int status = in_child([&] { runner.run(next, stop); });
        if (status == 0) {
            next = stop;
            continue;
        }
        const CaseOutcome outcome = {false, how_it_ended(status), 0.0, 0.0};
        runner.tell(board.current, outcome.defect);
        runner.count(outcome, board.current, std::nullopt);
        next = board.current + 1;
    }
    print_summary(board);
    FuzzSummary summary;
    for (const KindCounts& counts : board.kinds) {
        summary.run += counts.run;
        summary.results += counts.results;
        summary.refused += counts.refused;
        summary.defects += counts.defects;
    }
    return summary;
}

}  // namespace opal::fuzz
