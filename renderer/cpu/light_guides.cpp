// SPDX-License-Identifier: Apache-2.0
#include "renderer/cpu/light_guides.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "renderer/core/photon_walk.h"

namespace opal {
namespace {

constexpr std::uint32_t photons = 1u << 16;
constexpr int cells_across = 8;  ///< along the longest side of a body
/// Photons are added in integers of this fraction of a mean photon's flight through a cell.
constexpr float resolution = 0x1p-16f;
constexpr float largest_deposit = 0x1p12f;

bool scatters(const MediumView& medium) {
    return medium.sigma_s_rayleigh_400nm_per_mm > 0.0f ||
           std::any_of(medium.sigma_s_mie_per_mm, medium.sigma_s_mie_per_mm + spectrum_samples, [](float s) { return s > 0.0f; });
}

/// The phase functions' mixture where the medium does not vary, in the middle of the spectrum: guiding needs no more. Kept from
/// 0, so that light from any side can be drawn.
void set_phase(const MediumView& medium, LightGuideView& guide) {
    constexpr float wavelength_nm = 550.0f;
    PathWavelengths<1> wavelengths;
    wavelengths.wavelength_nm[0] = wavelength_nm;
    const LaneMedium<1> lanes = lane_medium(medium, wavelengths);
    for (int node = 0; node < guide_phase_nodes; ++node) {
        const float cosine = -1.0f + 2.0f * (float(node) + 0.5f) / float(guide_phase_nodes);
        guide.phase[node] =
            max_of(1.0e-4f, phase_mixture(medium, lanes.sigma_rayleigh.v[0], lanes.sigma_mie.v[0], cosine, wavelength_nm));
    }
}

/// What photons leave behind in one body.
class PhotonCounts {
  public:
    PhotonCounts(const MeshData& mesh, LightGuideView& guide) : guide_(guide) {
        Vec3 low = mesh.positions[0], high = low;
        for (const Vec3& p : mesh.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const Vec3 size = high - low;
        bounds_ = {0.5f * (low + high), 0.5f * length(size)};
        cell_mm_ = max_abs(size) / float(cells_across);
        const real sizes[3] = {size.x, size.y, size.z};
        for (int axis = 0; axis < 3; ++axis) guide.cells[axis] = std::max(1, int(std::ceil(sizes[axis] / cell_mm_ - 0.01f)));
        guide.corner_mm = low;
        guide.cells_per_mm = {float(guide.cells[0]) / size.x, float(guide.cells[1]) / size.y, float(guide.cells[2]) / size.z};
        counts_.assign(std::size_t(guide.cells[0]) * guide.cells[1] * guide.cells[2] * guide_bins, 0);
    }

    const BodyBounds& bounds() const { return bounds_; }

    /// Light travels along `direction`: paths from the camera find it the other way.
    void add(Vec3 from, Vec3 direction, float length_mm, float power) {
        const int bin = guide_bin(-direction);
        const int steps = 1 + int(2.0f * length_mm / cell_mm_);
        const float amount = std::min(largest_deposit, power * length_mm / (float(steps) * cell_mm_));
        const auto units = std::uint64_t(amount / resolution);
        if (units == 0) return;
        for (int step = 0; step < steps; ++step) {
            const Vec3 place = from + (length_mm * (float(step) + 0.5f) / float(steps)) * direction;
            const std::size_t index = std::size_t(guide_cell(guide_, place)) * guide_bins + std::size_t(bin);
            std::atomic_ref<std::uint64_t>(counts_[index]).fetch_add(units, std::memory_order_relaxed);
        }
    }

    /// Shares of the bins in each cell; all 0 in one that no light reaches.
    std::vector<float> shares() const {
        std::vector<float> result;
        result.reserve(counts_.size());
        for (std::size_t cell = 0; cell < counts_.size(); cell += guide_bins) {
            double total = 0.0;
            for (std::size_t bin = 0; bin < guide_bins; ++bin) total += double(counts_[cell + bin]);
            for (std::size_t bin = 0; bin < guide_bins; ++bin)
                result.push_back(total > 0.0 ? float(double(counts_[cell + bin]) / total) : 0.0f);
        }
        return result;
    }

  private:
    LightGuideView& guide_;
    BodyBounds bounds_;
    float cell_mm_;
    std::vector<std::uint64_t> counts_;
};

}  // namespace

LightGuides::LightGuides(const HostScene& scene, const EmbreeScene& intersector) : view_(scene.view()) {
    if (!scene.guided()) return;
    for (const MeshData& mesh : scene.meshes()) {
        if (mesh.body < 0) continue;
        if (bodies_.empty()) bodies_.assign(view_.bodies, view_.bodies + scene.num_bodies());
        const OpalView& body = view_.bodies[mesh.body];
        if (!scatters(body.medium) || !(total_importance(view_.lights, body.world_from_object.origin) > 0.0f)) continue;
        LightGuideView guide;
        PhotonCounts counts(mesh, guide);
        const float mean_power = total_importance(view_.lights, counts.bounds().center_mm);
        tbb::parallel_for(0u, photons, [&](std::uint32_t photon) {
            trace_photon(view_, intersector, mesh.body, counts.bounds(), photon,
                         [&](Vec3 from, Vec3 direction, float length_mm, float power) {
                             counts.add(from, direction, length_mm, power / mean_power);
                         });
        });
        weights_.push_back(counts.shares());
        guide.weight = weights_.back().data();
        set_phase(body.medium, guide);
        bodies_[mesh.body].guide = guide;
    }
    if (!bodies_.empty()) view_.bodies = bodies_.data();
}

}  // namespace opal
