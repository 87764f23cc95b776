// SPDX-License-Identifier: GPL-3.0-or-later
#include "program_run.h"

#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "formats/command.h"
#include "modeler/command_line.h"
#include "renderer/render_command.h"

namespace opal::fuzz {
namespace {

/// Standard output and error go to a file without a name while it lives.
class OutputCapture {
  public:
    OutputCapture() : file_(std::tmpfile()), out_(::dup(1)), err_(::dup(2)) {
        if (!file_) throw std::runtime_error("no temporary file");
        flush();
        ::dup2(::fileno(file_), 1);
        ::dup2(::fileno(file_), 2);
    }
    ~OutputCapture() {
        flush();
        ::dup2(out_, 1);
        ::dup2(err_, 2);
        ::close(out_);
        ::close(err_);
        std::fclose(file_);
    }
    OutputCapture(const OutputCapture&) = delete;
    OutputCapture& operator=(const OutputCapture&) = delete;

    std::string text() const {
        flush();
        std::string text;
        std::rewind(file_);
        char buffer[4096];
        for (std::size_t size = 0; (size = std::fread(buffer, 1, sizeof buffer, file_)) > 0;) text.append(buffer, size);
        return text;
    }

  private:
    static void flush() {
        std::fflush(stdout);
        std::fflush(stderr);
    }

    std::FILE* const file_;
    const int out_, err_;
};

}  // namespace

ProgramRun run_program(const std::vector<std::string>& command) {
    std::vector<std::string> words = command;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int argc = int(words.size());
    ProgramRun run;
    const OutputCapture capture;
    run.exit_code = run_command(command[0], [&] {
        return command[0] == "opal-model" ? run_opal_model(argc, argv.data()) : opal_render(argc, argv.data());
    });
    run.text = capture.text();
    return run;
}

}  // namespace opal::fuzz
