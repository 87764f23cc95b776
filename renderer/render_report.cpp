// SPDX-License-Identifier: Apache-2.0
#include "renderer/render_report.h"

#include <cmath>

#include "formats/report.h"
#include "renderer/host/film_noise.h"

namespace opal {
namespace {

nlohmann::json spectrum_report(const SpectrumTotals& totals, const SpectrumTables& tables) {
    nlohmann::json bins = nlohmann::json::array();
    const double n = std::max<double>(1.0, double(totals.samples));
    for (int bin = 0; bin < num_bins; ++bin) {
        // Mean of the white over the bin, so that a white furnace reports 1.
        double white = 0.0;
        int count = 0;
        for (double wavelength = std::max(360.0, bin_centre_nm(bin) - 5.0);
             wavelength <= std::min(830.0, bin_centre_nm(bin) + 5.0); wavelength += 0.25, ++count)
            white += double(table_at(tables.white, float(wavelength)));
        white /= count;
        const double mean = totals.radiance[bin] / n;
        const double variance = std::max(0.0, totals.radiance_squared[bin] / n - mean * mean) / std::max(1.0, n - 1.0);
        bins.push_back({{"wavelength_nm", bin_centre_nm(bin)},
                        {"radiance_over_white", mean / white},
                        {"standard_error", std::sqrt(variance) / white},
                        {"truncated", totals.truncated[bin] / n}});
    }
    return bins;
}

/// Null where the picture has too few samples to tell.
nlohmann::json noise_report(const Film& film) {
    const std::optional<PictureNoise> noise = picture_noise(film);
    if (!noise) return nullptr;
    const auto levels = [](double median, double percentile_95) {
        return nlohmann::json{{"median", median}, {"percentile_95", percentile_95}};
    };
    return {{"luminance", levels(noise->median.luminance, noise->percentile_95.luminance)},
            {"chroma", levels(noise->median.chroma, noise->percentile_95.chroma)},
            {"floor_luminance", film.noise_floor()}};
}

nlohmann::json checkpoint_report(const CheckpointCounts& counts) {
    nlohmann::json report = {{"written", counts.written}, {"failed", counts.failed}, {"resumed_from", nullptr}};
    if (counts.resumed_from)
        report["resumed_from"] = {{"samples_per_pixel", counts.resumed_from->samples_per_pixel},
                                  {"seconds", counts.resumed_from->render_s}};
    return report;
}

/// Null where no device with a clock of its own drew.
nlohmann::json device_seconds_report(const RenderOutcome& outcome) {
    if (!outcome.device_seconds) return nullptr;
    return {{"trace", outcome.device_seconds->trace}, {"add", outcome.device_seconds->add}};
}

nlohmann::json grains_report(const HostScene& host) {
    nlohmann::json opals = nlohmann::json::array();
    for (const auto& opal : host.opals())
        opals.push_back({{"method", opal->grains().method_name()}, {"memory_bytes", opal->grains().size_bytes()}});
    return opals;
}

}  // namespace

nlohmann::json render_report(const SceneDescription& scene, const HostScene& host, const RenderOutcome& outcome, const Film& film,
                             const CheckpointKeeper& keeper, const StageSeconds& stages, int threads,
                             const DeviceChoice& device) {
    const PathCounters& counters = outcome.counters;
    const std::uint64_t samples = film.total_samples();
    return {{"seconds",
             {{"loading", stages.tables + stages.objects + stages.rays},
              {"loading_tables", stages.tables},
              {"loading_objects", stages.objects},
              {"loading_rays", stages.rays},
              {"rendering", outcome.seconds},
              {"rendering_before_resume", keeper.earlier_s()},
              {"writing", stages.writing}}},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"threads", threads},
            {"device", device.cuda ? "cuda" : "cpu"},
            {"device_reason", device.reason},
            {"device_names", outcome.devices},
            {"device_seconds", device_seconds_report(outcome)},
            {"seed", scene.render.seed},
            {"interrupted", outcome.interrupted},
            {"counts",
             {{"samples", samples},
              {"samples_per_pixel", outcome.finished_samples},
              {"new_samples", outcome.new_samples},
              {"grains", host.num_grains()},
              {"reciprocal_points", host.reciprocal_points()},
              {"grain_crossings", counters.grain_crossings},
              {"diffractions_back", counters.turns_back},
              {"multi_beam_stays", counters.multi_beam_stays},
              {"diffractions", counters.diffractions},
              {"scatterings", counters.scatterings},
              {"truncated_paths", counters.truncated_paths},
              {"lost_paths", counters.lost_paths},
              {"not_a_number", counters.not_a_number},
              {"majorant_violations", counters.majorant_violations}}},
            {"paths_per_second", double(outcome.new_samples) / std::max(1.0e-9, outcome.seconds)},
            {"grains", grains_report(host)},
            {"truncated_rgb",
             {outcome.totals.truncated_rgb[0] / double(samples), outcome.totals.truncated_rgb[1] / double(samples),
              outcome.totals.truncated_rgb[2] / double(samples)}},
            {"noise", noise_report(film)},
            {"checkpoints", checkpoint_report(keeper.counts())},
            {"spectrum", spectrum_report(outcome.totals, host.view().spectra)},
            {"versions", version_report()},
            {"scene", scene_to_toml(scene)}};
}

}  // namespace opal
