// Symmetric positive definite systems of up to 10 unknowns, in place.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace quadseg::surface {

inline constexpr int most_unknowns = 10;

struct SmallSystem {
    int size = 0;
    double h[most_unknowns][most_unknowns] = {};  ///< the lower triangle counts
    double g[most_unknowns] = {};

    explicit SmallSystem(int n) : size(n) {}

    /// (h + damping·diag(h) + least·max(diag(h))) x = sign·g by Cholesky on the unit-diagonal scaling. False: not
    /// positive definite.
    bool solve(double damping, double least, double sign, double* x) const noexcept {
        double s[most_unknowns], l[most_unknowns][most_unknowns], top = 0;
        for (int i = 0; i < size; ++i) top = std::fmax(top, h[i][i]);
        for (int i = 0; i < size; ++i) {
            const double diagonal = h[i][i] * (1 + damping) + least * top;
            if (!(diagonal > 0)) return false;
            s[i] = 1 / std::sqrt(diagonal);
        }
        for (int i = 0; i < size; ++i) {
            for (int j = 0; j <= i; ++j) {
                double sum = i == j ? 1 : h[i][j] * s[i] * s[j];
                for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
                if (i == j) {
                    if (!(sum > 1e-16)) return false;
                    l[i][i] = std::sqrt(sum);
                } else {
                    l[i][j] = sum / l[j][j];
                }
            }
        }
        for (int i = 0; i < size; ++i) {
            double sum = sign * g[i] * s[i];
            for (int k = 0; k < i; ++k) sum -= l[i][k] * x[k];
            x[i] = sum / l[i][i];
        }
        for (int i = size - 1; i >= 0; --i) {
            double sum = x[i];
            for (int k = i + 1; k < size; ++k) sum -= l[k][i] * x[k];
            x[i] = sum / l[i][i];
        }
        bool finite = true;
        for (int i = 0; i < size; ++i) {
            x[i] *= s[i];
            finite = finite && std::isfinite(x[i]);
        }
        return finite;
    }
};

}  // namespace quadseg::surface
