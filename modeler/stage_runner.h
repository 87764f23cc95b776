// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/command.h"
#include "modeler/build_report.h"

namespace opal {

/// Runs stages, timing and announcing them; between two, Ctrl-C ends the work (Interrupted).
class StageRunner {
  public:
    StageRunner(BuildReport& report, const BuildListener& listener) : report_(report), listener_(listener) {}

    template <typename Work>
    auto run(const std::string& stage, const Work& work) {
        throw_if_interrupted();
        listener_(stage);
        const Stopwatch watch;
        auto result = work();
        report_.stages.push_back({stage, watch.seconds()});
        return result;
    }

    void warn(const std::string& warning) {
        report_.warnings.push_back(warning);
        listener_("warning: " + warning);
    }

  private:
    BuildReport& report_;
    const BuildListener& listener_;
};

}  // namespace opal
