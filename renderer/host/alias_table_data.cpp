// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/alias_table_data.h"

namespace opal {

AliasTableData make_alias_table(const std::vector<float>& weights) {
    double total = 0.0;
    for (const float weight : weights) total += double(weight);
    AliasTableData table;
    table.columns.resize(weights.size());
    std::vector<double> height(weights.size());
    std::vector<int> low, high;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        height[i] = double(weights[i]) * double(weights.size()) / total;
        (height[i] < 1.0 ? low : high).push_back(static_cast<int>(i));
    }
    while (!low.empty() && !high.empty()) {
        const int poor = low.back(), rich = high.back();
        low.pop_back();
        table.columns[std::size_t(poor)] = {float(height[std::size_t(poor)]), rich};
        height[std::size_t(rich)] -= 1.0 - height[std::size_t(poor)];
        if (height[std::size_t(rich)] < 1.0) {
            high.pop_back();
            low.push_back(rich);
        }
    }
    // What is left is 1 but for rounding.
    for (const std::vector<int>* rest : {&low, &high})
        for (const int i : *rest) table.columns[std::size_t(i)] = {1.0f, i};
    return table;
}

}  // namespace opal
