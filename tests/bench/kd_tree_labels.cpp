// SPDX-License-Identifier: GPL-3.0-or-later
#include "kd_tree_labels.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <nanoflann.hpp>

#include "formats/command.h"
#include "modeler/tessellation_metric.h"

namespace opal {
namespace {

struct SiteCloud {
    const std::vector<Site>& sites;

    std::size_t kdtree_get_point_count() const { return sites.size(); }
    double kdtree_get_pt(std::size_t index, std::size_t axis) const { return sites[index].position_mm[static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, SiteCloud>, SiteCloud, 3, std::size_t>;
using Metric = TessellationMetric<TessellationKind::additive>;

class OwnerQuery {
  public:
    OwnerQuery(const std::vector<Site>& sites, const Tree& tree, bool weights_count) : sites_(sites), tree_(tree) {
        for (const Site& site : sites) largest_weight_mm_ = std::max(largest_weight_mm_, static_cast<double>(site.weight_mm));
        first_count_ = weights_count ? 8 : 1;
        weights_count_ = weights_count;
    }

    /// Sites found and their squared distances, kept from query to query.
    struct Found {
        std::vector<std::size_t> index;
        std::vector<double> squared_mm2;
    };

    std::size_t owner(const openvdb::Vec3d& place_mm, Found& buffers) const {
        auto& [index, squared_mm2] = buffers;
        for (std::size_t count = first_count_;; count *= 2) {
            if (index.size() < count) {
                index.resize(count);
                squared_mm2.resize(count);
            }
            const std::size_t found = tree_.knnSearch(place_mm.asPointer(), count, index.data(), squared_mm2.data());
            if (!weights_count_) return index[0];
            std::size_t best = 0;
            double smallest_mm = std::numeric_limits<double>::infinity();
            for (std::size_t n = 0; n < found; ++n) {
                const double delta_mm = Metric::delta_mm(place_mm, sites_[index[n]]);
                if (delta_mm < smallest_mm || (delta_mm == smallest_mm && index[n] < best)) {
                    smallest_mm = delta_mm;
                    best = index[n];
                }
            }
            if (found < count || std::sqrt(squared_mm2[found - 1]) - largest_weight_mm_ > smallest_mm) return best;
        }
    }

  private:
    const std::vector<Site>& sites_;
    const Tree& tree_;
    double largest_weight_mm_ = -std::numeric_limits<double>::infinity();
    std::size_t first_count_;
    bool weights_count_;
};

}  // namespace

KdTreeLabels label_by_kd_tree(const std::vector<Site>& sites, const std::vector<std::int32_t>& label_of_site,
                              const openvdb::Int32Grid& labels, std::size_t stride, bool weights_count) {
    const SiteCloud cloud{sites};
    const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    const OwnerQuery query(sites, tree, weights_count);
    const openvdb::tree::LeafManager<const openvdb::Int32Tree> leaves(labels.tree());
    std::atomic<std::uint64_t> voxels = 0, differences = 0;
    const Stopwatch watch;
    tbb::parallel_for(std::size_t(0), (leaves.leafCount() + stride - 1) / stride, [&](std::size_t n) {
        std::uint64_t asked = 0, wrong = 0;
        OwnerQuery::Found buffers;
        for (auto value = leaves.leaf(n * stride).cbeginValueOn(); value; ++value, ++asked)
            wrong += label_of_site[query.owner(labels.indexToWorld(value.getCoord()), buffers)] != *value ? 1 : 0;
        voxels += asked;
        differences += wrong;
    });
    return {watch.seconds(), voxels, differences};
}

}  // namespace opal
