// The scale interval's angle bounds and height against numeric search over all elements whose edge
// lengths lie in S, for the adaptation's closed forms and the checker's own derivation.

#include "adaptation/scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "adaptation/conformity_measures.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<double, 7> kRatios{1.01, 1.05, 1.14, 1.35, 1.5, 1.62, 1.73};

using Lengths = std::array<double, 3>;  ///< two sides of a corner, then what it faces

double corner_angle(const Lengths& l) {
    const double cosine = (l[0] * l[0] + l[1] * l[1] - l[2] * l[2]) / (2 * l[0] * l[1]);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double altitude(const Lengths& l) {
    const double s = (l[0] + l[1] + l[2]) / 2;
    const double square = s * (s - l[0]) * (s - l[1]) * (s - l[2]);
    return 2 * std::sqrt(std::max(0.0, square)) / *std::max_element(l.begin(), l.end());
}

/// Least value over the box by pattern search from random starts: knows nothing of corners.
double minimise(const std::function<double(const Lengths&)>& value, const Lengths& low,
                const Lengths& high) {
    std::mt19937_64 random(7);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    double best = 1e300;
    for (int start = 0; start < 60; ++start) {
        Lengths at;
        for (int k = 0; k < 3; ++k) at[k] = low[k] + uniform() * (high[k] - low[k]);
        double here = value(at);
        for (double step = 0.25; step > 1e-10;) {
            bool is_better = false;
            for (int k = 0; k < 6; ++k) {
                Lengths next = at;
                next[k / 2] =
                    std::clamp(at[k / 2] + (k % 2 ? step : -step), low[k / 2], high[k / 2]);
                const double there = value(next);
                if (there < here) {
                    here = there;
                    at = next;
                    is_better = true;
                }
            }
            if (!is_better) step /= 2;
        }
        best = std::min(best, here);
    }
    return best;
}

struct Extremes {
    double smallest, largest;
};

Extremes numeric_angles(double ratio, bool is_quad) {
    const double unit = is_quad ? std::numbers::sqrt2 : 1.0;
    const Lengths low{1, 1, unit};
    const Lengths high{ratio, ratio, unit * ratio};
    return {minimise(corner_angle, low, high),
            -minimise([](const Lengths& l) { return -corner_angle(l); }, low, high)};
}

TEST(AngleBounds, TriangleAgainstNumericSearch) {
    for (const double ratio : kRatios) {
        const Extremes expected = numeric_angles(ratio, false);
        const ScaleInterval scale = make_scale(2.0, ratio);
        const conformity::AngleBounds bounds = conformity::angle_bounds(ratio, false);
        EXPECT_NEAR(scale.alpha_min, expected.smallest, 1e-8) << ratio;
        EXPECT_NEAR(scale.alpha_max, expected.largest, 1e-8) << ratio;
        EXPECT_NEAR(bounds.smallest, expected.smallest, 1e-8) << ratio;
        EXPECT_NEAR(bounds.largest, expected.largest, 1e-8) << ratio;
        EXPECT_EQ(scale.multiples, 3);
        EXPECT_EQ(bounds.multiples, 3);
        EXPECT_DOUBLE_EQ(scale.triangle_alpha_min, scale.alpha_min);
        EXPECT_GE(3 * scale.alpha_max, kPi - 1e-12);  // nothing beyond k = 3 (paper 4.1)
    }
}

TEST(AngleBounds, QuadAgainstNumericSearch) {
    for (const double ratio : kRatios) {
        const Extremes expected = numeric_angles(ratio, true);
        const ScaleInterval scale = make_scale(0.3, ratio, ElementType::Quad);
        const conformity::AngleBounds bounds = conformity::angle_bounds(ratio, true);
        EXPECT_NEAR(scale.alpha_min, expected.smallest, 1e-7) << ratio;
        EXPECT_NEAR(scale.alpha_max, expected.largest, 1e-7) << ratio;
        EXPECT_NEAR(bounds.smallest, expected.smallest, 1e-7) << ratio;
        EXPECT_NEAR(bounds.largest, expected.largest, 1e-7) << ratio;
        EXPECT_EQ(scale.multiples, 2);
        EXPECT_EQ(bounds.multiples, 2);
        EXPECT_NEAR(scale.triangle_alpha_min, numeric_angles(ratio, false).smallest, 1e-8);
    }
}

// The closed forms as DESIGN 4.1 and the paper's section 4.1 print them.
TEST(AngleBounds, ClosedForms) {
    for (const double r : kRatios) {
        const auto triangle = conformity::angle_bounds(r, false);
        const double type_a = std::acos(r / 2);
        const double type_b = 2 * std::asin(1 / (2 * r));
        EXPECT_NEAR(triangle.smallest, std::min(type_a, type_b), 1e-12);
        EXPECT_EQ(type_b < type_a, r < 1.618) << "the paper's change-over at the golden ratio";
        EXPECT_NEAR(triangle.largest, std::max(2 * std::asin(r / 2), std::acos(1 / (2 * r))),
                    1e-12);
        const auto quad = conformity::angle_bounds(r, true);
        const double kite = std::acos((r * r + 1) / (2 * std::numbers::sqrt2 * r));
        EXPECT_NEAR(quad.smallest, 2 * std::min(std::asin(1 / (std::numbers::sqrt2 * r)), kite),
                    1e-7);
        EXPECT_NEAR(quad.largest,
                    2 * std::max(std::asin(std::min(1.0, r / std::numbers::sqrt2)), kite), 1e-7);
    }
    // Paper 4.1: the intervals merge above 1.365.
    EXPECT_GT(2 * conformity::angle_bounds(1.364, false).smallest,
              conformity::angle_bounds(1.364, false).largest);
    EXPECT_LT(2 * conformity::angle_bounds(1.366, false).smallest,
              conformity::angle_bounds(1.366, false).largest);
}

TEST(Scale, HeightIsTheFlattestTriangles) {
    for (const double ratio : kRatios) {
        const double expected = minimise(altitude, {1, 1, 1}, {ratio, ratio, ratio});
        EXPECT_NEAR(make_scale(1.0, ratio).height, expected, 1e-8) << ratio;
        EXPECT_NEAR(make_scale(0.02, ratio).height, 0.02 * expected, 1e-9) << ratio;
    }
}

TEST(Scale, IntervalAndTolerance) {
    const ScaleInterval scale = make_scale(2.0, 1.5);
    EXPECT_DOUBLE_EQ(scale.rmin, 2.0);
    EXPECT_DOUBLE_EQ(scale.rmax, 3.0);
    EXPECT_DOUBLE_EQ(scale.ratio(), 1.5);
    EXPECT_TRUE(scale.contains(2.0 * (1 - 0.5e-6)));
    EXPECT_FALSE(scale.contains(2.0 * (1 - 2e-6)));
    EXPECT_TRUE(scale.contains(3.0 * (1 + 0.5e-6)));
    EXPECT_FALSE(scale.contains(3.0 * (1 + 2e-6)));
}

void expect_feasible_like_bounds(const ScaleInterval& scale, double angle) {
    bool is_feasible = false;
    for (int k = 1; k <= scale.multiples; ++k) {
        is_feasible |= angle >= k * scale.alpha_min && angle <= k * scale.alpha_max;
    }
    EXPECT_EQ(scale.is_feasible_angle(angle), is_feasible)
        << angle << " at ratio " << scale.ratio();
}

TEST(Scale, FeasibleAnglesAtEveryLimit) {
    for (const double ratio : kRatios) {
        for (const ElementType type : {ElementType::Triangle, ElementType::Quad}) {
            const ScaleInterval scale = make_scale(1.0, ratio, type);
            const auto bounds = conformity::angle_bounds(ratio, type == ElementType::Quad);
            for (int k = 1; k <= scale.multiples; ++k) {
                for (const double limit : {k * scale.alpha_min, k * scale.alpha_max}) {
                    EXPECT_TRUE(scale.is_feasible_angle(limit * (1 - 0.5e-6)));
                    EXPECT_TRUE(scale.is_feasible_angle(limit * (1 + 0.5e-6)));
                    expect_feasible_like_bounds(scale, limit * (1 - 3e-6));
                    expect_feasible_like_bounds(scale, limit * (1 + 3e-6));
                }
            }
            for (int i = 0; i <= 1000; ++i) {
                const double angle = kPi * i / 1000;
                EXPECT_EQ(scale.is_feasible_angle(angle), bounds.contains(angle, 1e-6)) << angle;
            }
            EXPECT_FALSE(scale.is_feasible_angle(0.0));
            EXPECT_TRUE(scale.is_feasible_angle(kPi));
        }
    }
}

TEST(Scale, RefusesWhatHasNoScale) {
    EXPECT_THROW(make_scale(0.0), InputError);
    EXPECT_THROW(make_scale(-1.0), InputError);
    EXPECT_THROW(make_scale(std::nan("")), InputError);
    EXPECT_THROW(make_scale(INFINITY), InputError);
    EXPECT_THROW(make_scale(1.0, 1.009), InputError);
    EXPECT_THROW(make_scale(1.0, std::sqrt(3.0)), InputError);
    EXPECT_THROW(make_scale(1.0, std::nan("")), InputError);
    EXPECT_NO_THROW(make_scale(1.0, 1.01));
    EXPECT_NO_THROW(make_scale(1.0, 1.732));
}

}  // namespace
}  // namespace fcn
