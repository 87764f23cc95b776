// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability_percolation.h"

#include "formats/recipe.h"
#include "modeler/neighbour_graph.h"
#include "modeler/shape.h"
#include "modeler/sintering.h"
#include "modeler/sites.h"
#include "modeler/weights.h"

namespace opal {

std::vector<PercolationSpread> percolation_spread(std::size_t sites, const std::vector<double>& probabilities, int seeds) {
    ShapeRecipe ball;
    ball.kind = ShapeKind::sphere;
    ball.size_mm = {10.0, 10.0, 10.0};
    const auto shape = make_shape(ball);
    const SiteSet set = sample_sites(*shape, sites, 1);
    const std::vector<Site> weighed = weigh_sites(set, GrainsRecipe{}, *shape).sites;
    const std::vector<char> hidden(sites, 0);
    const NeighbourGraph graph = apollonius_graph(weighed, hidden, *shape, set.spacing_mm());
    std::vector<PercolationSpread> spreads;
    for (const double p : probabilities) {
        SinteringRecipe recipe;
        recipe.probability = p;
        SampleMean largest, grains, threshold;
        int warned = 0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const Sintering sintering = sinter(graph, hidden, recipe, std::uint64_t(seed));
            largest.add(sintering.largest_grain_fraction);
            grains.add(double(sintering.num_grains));
            threshold.add(sintering.threshold.value_or(1.0));
            warned += sintering.largest_grain_fraction > 0.2 ? 1 : 0;
        }
        spreads.push_back({largest.estimate(), largest.deviation(), grains.deviation() / grains.estimate().mean,
                           threshold.deviation(), threshold.estimate().mean, double(warned) / seeds, seeds});
    }
    return spreads;
}

void add_percolation_rows(bool quick, StabilityRows& rows) {
    const int seeds = quick ? 10 : 60;
    const std::string outcome =
        "a warning names the share, p and the threshold where one grain holds over a fifth of the sites; "
        "grains = N or mean_grain_mm reach their number exactly";
    const std::string test = "Build.WarnsPastThePercolationThreshold; Stability.TheLargestGrainVariesAtTheThreshold";
    for (const std::size_t sites : {std::size_t(1000), std::size_t(10000)}) {
        if (quick && sites > 1000) continue;
        const std::vector<double> probabilities = {0.02, 0.04, 0.06, 0.07, 0.08, 0.085, 0.09, 0.095, 0.1, 0.11, 0.12, 0.15, 0.2};
        const std::vector<PercolationSpread> spreads = percolation_spread(sites, probabilities, seeds);
        for (std::size_t n = 0; n < spreads.size(); ++n) {
            const PercolationSpread& spread = spreads[n];
            // Of a standard deviation, as of normal numbers.
            const double relative = 1.0 / std::sqrt(2.0 * (spread.seeds - 1));
            const auto add = [&](Estimate value, const std::string& unit) {
                rows.push_back({"percolation", sites == 1000 ? "1,000 sites" : "10,000 sites", "bond probability p",
                                probabilities[n], value, unit, outcome, test});
            };
            add(spread.largest, "share of the sites in the largest grain");
            add({spread.largest_deviation, relative * spread.largest_deviation}, "standard deviation of that share over seeds");
            add({spread.grains_deviation, relative * spread.grains_deviation}, "relative deviation of the number of grains");
            add(share_of(std::uint64_t(std::lround(spread.warned * spread.seeds)), std::uint64_t(spread.seeds)),
                "share of the seeds that warn");
        }
        rows.push_back({"percolation",
                        sites == 1000 ? "1,000 sites" : "10,000 sites",
                        "reported threshold",
                        spreads[0].threshold,
                        {spreads[0].threshold_deviation, spreads[0].threshold_deviation / std::sqrt(2.0 * (seeds - 1))},
                        "standard deviation of the reported threshold over seeds",
                        outcome,
                        test});
    }
}

}  // namespace opal
