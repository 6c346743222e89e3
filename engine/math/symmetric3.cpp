#include "math/symmetric3.h"

#include <cmath>
#include <utility>

namespace quadseg {

EigenSystem eigen_decomposition(const Symmetric3& m) noexcept {
    double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 30; ++sweep) {
        const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        const double diagonal = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
        if (!(off > 1e-34 * diagonal)) break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0) continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; ++k) {
                    const double kp = a[k][p], kq = a[k][q];
                    a[k][p] = c * kp - s * kq;
                    a[k][q] = s * kp + c * kq;
                }
                for (int k = 0; k < 3; ++k) {
                    const double pk = a[p][k], qk = a[q][k];
                    a[p][k] = c * pk - s * qk;
                    a[q][k] = s * pk + c * qk;
                }
                for (auto& row : v) {
                    const double vp = row[p], vq = row[q];
                    row[p] = c * vp - s * vq;
                    row[q] = s * vp + c * vq;
                }
            }
        }
    }
    int order[3] = {0, 1, 2};
    const auto sort = [&](int& i, int& j) {
        if (a[j][j] < a[i][i]) std::swap(i, j);
    };
    sort(order[0], order[1]);
    sort(order[1], order[2]);
    sort(order[0], order[1]);
    EigenSystem result{};
    for (int k = 0; k < 3; ++k) {
        result.values[k] = a[order[k]][order[k]];
        result.vectors[k] = normalized({v[0][order[k]], v[1][order[k]], v[2][order[k]]});
    }
    result.vectors[2] = cross(result.vectors[0], result.vectors[1]);
    return result;
}

}  // namespace quadseg
