// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "fuzz_case.h"
#include "program_run.h"

namespace opal::fuzz {

/// Success, or exit code 2 with exactly one line "error: ..." in words of ours; the latter only where a case may be refused.
void judge_run(const ProgramRun& run, bool may_refuse, CaseOutcome& outcome);

/// out.exr, or the frames of an animation, with its statistics: see judge_picture; and no samples that were not numbers, no
/// collisions above a majorant. Counts the lost paths.
void judge_rendered(const std::filesystem::path& folder, CaseOutcome& outcome);

/// Every value is a finite number; in a picture that was rendered here, variances, sample counts, depths and spectral radiance
/// are not negative.
void judge_picture(const std::filesystem::path& file, bool made_here, CaseOutcome& outcome);

/// After an error there are no outputs but a checkpoint, nor temporary files.
void judge_nothing_left(const std::filesystem::path& folder, CaseOutcome& outcome);

}  // namespace opal::fuzz
