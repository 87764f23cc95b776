// SPDX-License-Identifier: Apache-2.0
#include "renderer/host/spectrum_tables.h"

#include "formats/cie_tables.h"
#include "formats/colorimetry.h"
#include "formats/rgb_basis.h"

namespace opal {
namespace {

float basis_at(int primary, int index_1nm) {
    const int i = std::min(index_1nm / 10, 46);
    const float t = float(index_1nm - 10 * i) / 10.0f;
    return (1.0f - t) * rgb_basis_10nm[primary][i] + t * rgb_basis_10nm[primary][i + 1];
}

}  // namespace

SpectrumTablesData make_spectrum_tables() {
    SpectrumTablesData tables;
    double y_integral = 0.0, white_y = 0.0;
    for (int i = 0; i < spectrum_samples; ++i) {
        y_integral += double(cie_1931_observer[i].y);
        white_y += double(cie_1931_observer[i].y) * cie_d65_at(colorimetric_min_nm + i);
    }
    for (int i = 0; i < spectrum_samples; ++i) {
        const CieObserverRow& row = cie_1931_observer[i];
        const float scale = float(1.0 / y_integral);
        tables.observer.push_back({row.x * scale, row.y * scale, row.z * scale});
        tables.white.push_back(float(cie_d65_at(colorimetric_min_nm + i) * y_integral / white_y));
        tables.rgb_basis.push_back({basis_at(0, i), basis_at(1, i), basis_at(2, i)});
    }
    std::vector<double> density;
    double total = 0.0;
    for (int i = 0; i + 1 < spectrum_samples; ++i) {
        const Vec3 a = tables.observer[i], b = tables.observer[i + 1];
        density.push_back(
            0.5 * (double(a.x + a.y + a.z) * double(tables.white[i]) + double(b.x + b.y + b.z) * double(tables.white[i + 1])));
        total += density.back();
    }
    tables.cdf.push_back(0.0f);
    double sum = 0.0;
    for (double& value : density) {
        value = 0.9 * value / total + 0.1 / double(spectrum_samples - 1);
        sum += value;
        tables.cdf.push_back(float(sum));
    }
    tables.cdf.back() = 1.0f;
    // The density is what the rounded table draws, so that inversion and density agree to the last digit.
    for (int i = 0; i + 1 < spectrum_samples; ++i) tables.pdf.push_back(tables.cdf[i + 1] - tables.cdf[i]);
    return tables;
}

}  // namespace opal
