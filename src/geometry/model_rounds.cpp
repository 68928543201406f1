// The models made of rings: each surface is a sequence of point rings (or open chains between two
// creases), as many points each as its length asks for, zipped together. Creases are rings or the
// ends of chains, so the mesh follows them exactly.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/errors.h"
#include "geometry/model_shapes.h"

namespace fcn {

namespace {

constexpr double kPi = std::numbers::pi;
/// Distance of rows of equilateral triangles, in edge lengths.
constexpr double kRowHeight = 0.866;

using Ring = std::vector<int>;

int ring_size(double radius, double resolution) {
    return std::max(5, static_cast<int>(std::lround(2 * kPi * radius / resolution)));
}

/// A circle about the z axis, counter-clockwise seen from above.
Ring add_ring(ModelSurface& surface, double radius, double z, int count, double shift) {
    Ring ring;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * kPi * (i + shift) / count;
        ring.push_back(surface.add({radius * std::cos(angle), radius * std::sin(angle), z}));
    }
    return ring;
}

Ring reversed(Ring ring) {
    std::reverse(ring.begin(), ring.end());
    return ring;
}

/// Fills the disc inside a ring at height z, facing up or down.
void fill_disc(ModelSurface& surface, const Ring& outline, double radius, double z,
               double resolution, bool is_up) {
    const int ring_count = piece_count(radius, kRowHeight * resolution);
    const double step = radius / ring_count;
    Ring outer = outline;
    for (int k = ring_count - 1; k >= 1; --k) {
        const Ring inner = add_ring(surface, k * step, z, ring_size(k * step, resolution), 0.25);
        is_up ? surface.zip_rings(outer, inner)
              : surface.zip_rings(reversed(outer), reversed(inner));
        outer = inner;
    }
    surface.cap(is_up ? outer : reversed(outer), {0, 0, z});
}

}  // namespace

ModelSurface make_cylinder(const ModelOptions& options) {
    constexpr double kRadius = 0.5;
    constexpr double kHeight = 1.0;
    check_triangle_count(4 * kPi * kRadius * (kRadius + kHeight) /
                         (options.resolution * options.resolution));
    ModelSurface surface;
    const int count = ring_size(kRadius, options.resolution);
    const int row_count = piece_count(kHeight, kRowHeight * options.resolution);
    Ring lower = add_ring(surface, kRadius, 0, count, 0);
    fill_disc(surface, lower, kRadius, 0, options.resolution, false);
    for (int row = 1; row <= row_count; ++row) {
        const Ring upper =
            add_ring(surface, kRadius, kHeight * row / row_count, count, 0.5 * (row % 2));
        surface.zip_rings(lower, upper);
        lower = upper;
    }
    fill_disc(surface, lower, kRadius, kHeight, options.resolution, true);
    return surface;
}

ModelSurface make_sphere(const ModelOptions& options) {
    constexpr double kRadius = 0.5;
    check_triangle_count(8 * kPi * kRadius * kRadius / (options.resolution * options.resolution));
    ModelSurface surface;
    const int row_count = std::max(4, piece_count(kPi * kRadius, kRowHeight * options.resolution));
    Ring lower;
    for (int row = 1; row < row_count; ++row) {
        const double angle = kPi * row / row_count;
        const double radius = kRadius * std::sin(angle);
        const Ring upper = add_ring(surface, radius, -kRadius * std::cos(angle),
                                    ring_size(radius, options.resolution), 0.25 * (row % 2));
        if (lower.empty()) {
            surface.cap(reversed(upper), {0, 0, -kRadius});
        } else {
            surface.zip_rings(lower, upper);
        }
        lower = upper;
    }
    surface.cap(lower, {0, 0, kRadius});
    return surface;
}

ModelSurface make_torus(const ModelOptions& options) {
    constexpr double kRadius = 0.35;
    constexpr double kTube = 0.15;
    check_triangle_count(8 * kPi * kPi * kRadius * kTube /
                         (options.resolution * options.resolution));
    ModelSurface surface;
    const int row_count =
        std::max(6, piece_count(2 * kPi * kTube, kRowHeight * options.resolution));
    std::vector<Ring> rings;
    for (int row = 0; row < row_count; ++row) {
        const double angle = 2 * kPi * row / row_count;
        const double radius = kRadius + kTube * std::cos(angle);
        rings.push_back(add_ring(surface, radius, kTube * std::sin(angle),
                                 ring_size(radius, options.resolution), 0.25 * (row % 2)));
    }
    for (int row = 0; row < row_count; ++row) {
        surface.zip_rings(rings[row], rings[(row + 1) % row_count]);
    }
    return surface;
}

namespace {

/// Points on the superellipse x^4 + z^4 = tube^4, evenly spaced along it.
std::vector<Eigen::Vector2d> superellipse(double tube, int count) {
    constexpr int kFine = 4096;
    const auto at = [&](double angle) -> Eigen::Vector2d {
        const double c = std::cos(angle), s = std::sin(angle);
        return Eigen::Vector2d(c, s) * tube / std::pow(c * c * c * c + s * s * s * s, 0.25);
    };
    std::vector<double> along{0};
    for (int i = 1; i <= kFine; ++i) {
        along.push_back(along.back() +
                        (at(2 * kPi * i / kFine) - at(2 * kPi * (i - 1) / kFine)).norm());
    }
    std::vector<Eigen::Vector2d> points;
    int i = 1;
    for (int k = 0; k < count; ++k) {
        const double target = along.back() * k / count;
        while (along[i] < target) ++i;
        const double share = (target - along[i - 1]) / (along[i] - along[i - 1]);
        points.push_back(at(2 * kPi * (i - 1 + share) / kFine));
    }
    return points;
}

}  // namespace

ModelSurface make_superellipse_torus(const ModelOptions& options) {
    constexpr double kRadius = 0.35;
    constexpr double kTube = 0.15;
    constexpr double kOutline = 7.0177;  // length of the superellipse of radius 1
    check_triangle_count(4 * kPi * kRadius * kOutline * kTube /
                         (options.resolution * options.resolution));
    ModelSurface surface;
    const int row_count =
        std::max(8, piece_count(kOutline * kTube, kRowHeight * options.resolution));
    std::vector<Ring> rings;
    for (const Eigen::Vector2d& at : superellipse(kTube, row_count)) {
        const double radius = kRadius + at.x();
        rings.push_back(add_ring(surface, radius, at.y(), ring_size(radius, options.resolution),
                                 0.25 * static_cast<double>(rings.size() % 2)));
    }
    for (int row = 0; row < row_count; ++row) {
        surface.zip_rings(rings[row], rings[(row + 1) % row_count]);
    }
    return surface;
}

namespace {

/// Outline and top face of a gear; the outline runs counter-clockwise.
class GearFace {
public:
    GearFace(const ModelOptions& options, double bore, double root, double tip)
        : options_(options), bore_(bore), root_(root), tip_(tip) {}

    void build(double z) {
        z_ = z;
        const double pitch = 2 * kPi / options_.count;
        const double root_half = 0.75 * options_.spacing / root_;
        const double tip_half = 0.5 * options_.spacing / tip_;
        Ring root_ring;
        for (int tooth = 0; tooth < options_.count; ++tooth) {
            const double middle = tooth * pitch;
            const Ring base = arc(root_, middle - root_half, middle + root_half);
            const Ring flank_to = add_tooth(base, middle, tip_half, root_half);
            outline.insert(outline.end(), flank_to.begin(), flank_to.end() - 1);
            Ring gap = arc(root_, middle + root_half, middle + pitch - root_half);
            root_ring.insert(root_ring.end(), base.begin(), base.end());
            // The ends of the gap are the teeth's corners, welded to them.
            outline.insert(outline.end(), gap.begin(), gap.end() - 1);
            root_ring.insert(root_ring.end(), gap.begin() + 1, gap.end() - 1);
        }
        fill_ring(root_ring);
    }

    ModelSurface surface;
    Ring outline, hole;

private:
    Vec3 polar(double radius, double angle) const {
        return {radius * std::cos(angle), radius * std::sin(angle), z_};
    }

    Ring arc(double radius, double from, double to) {
        Ring ring;
        const int count = piece_count(radius * (to - from), options_.resolution);
        for (int i = 0; i <= count; ++i) {
            ring.push_back(surface.add(polar(radius, from + (to - from) * i / count)));
        }
        return ring;
    }

    /// Rows from the base to the tip, each shorter than the last; returns the way around the tooth,
    /// from the base's first point to its last.
    Ring add_tooth(const Ring& base, double middle, double tip_half, double root_half) {
        const double height = tip_ - root_;
        const int row_count = piece_count(height, kRowHeight * options_.resolution);
        const int count = static_cast<int>(base.size()) - 1;
        Ring up{base.front()};
        Ring down{base.back()};
        Ring lower = base;
        for (int row = 1; row <= row_count; ++row) {
            const double part = static_cast<double>(row) / row_count;
            const double half = root_half + part * (tip_half - root_half);
            Ring upper;
            for (int i = 0; i <= count; ++i) {
                upper.push_back(surface.add(
                    polar(root_ + part * height, middle - half + 2 * half * i / count)));
            }
            // The base runs counter-clockwise, so outward is to its right.
            surface.zip(reversed(lower), reversed(upper));
            lower = upper;
            up.push_back(upper.front());
            down.push_back(upper.back());
        }
        up.insert(up.end(), lower.begin() + 1, lower.end() - 1);
        up.insert(up.end(), down.rbegin(), down.rend());
        return up;
    }

    void fill_ring(const Ring& root_ring) {
        const int ring_count = piece_count(root_ - bore_, kRowHeight * options_.resolution);
        Ring outer = root_ring;
        for (int k = 1; k <= ring_count; ++k) {
            const double radius = root_ - (root_ - bore_) * k / ring_count;
            const Ring inner =
                add_ring(surface, radius, z_, ring_size(radius, options_.resolution), 0.25);
            surface.zip_rings(outer, inner);
            outer = inner;
        }
        hole = outer;
    }

    const ModelOptions& options_;
    double bore_, root_, tip_;
    double z_ = 0;
};

/// Wall under a closed line of the top face, down to z = 0; the line runs counter-clockwise.
void add_wall(ModelSurface& surface, const Ring& line, double resolution, bool is_outer) {
    Ring upper = is_outer ? line : reversed(line);
    const double top = surface.points[line.front()].z();
    const int row_count = piece_count(top, kRowHeight * resolution);
    for (int row = row_count - 1; row >= 0; --row) {
        Ring lower;
        for (int index : upper) {
            Vec3 point = surface.points[index];
            point.z() = top * row / row_count;
            lower.push_back(surface.add(point));
        }
        for (std::size_t i = 0; i < upper.size(); ++i) {
            const std::size_t next = (i + 1) % upper.size();
            const std::array corners{lower[i], lower[next], upper[next], upper[i]};
            const std::size_t turn = (i + static_cast<std::size_t>(row)) % 2;
            surface.add_triangle(corners[turn], corners[turn + 1], corners[turn + 2]);
            surface.add_triangle(corners[turn], corners[turn + 2], corners[(turn + 3) % 4]);
        }
        upper = lower;
    }
}

}  // namespace

ModelSurface make_gear(const ModelOptions& options) {
    constexpr double kTip = 0.5;
    constexpr double kBore = 0.15;
    constexpr double kThickness = 0.2;
    const double root = kTip - options.spacing;
    const bool has_room =
        root > kBore + 0.02 && 2 * kPi * root > 1.9 * options.spacing * options.count;
    if (!has_room) {
        throw InputError("model gear: no room for " + std::to_string(options.count) +
                         " teeth of spacing " + std::to_string(options.spacing) +
                         " around a radius of 0.5");
    }
    check_triangle_count(6 / (options.resolution * options.resolution));
    GearFace face(options, kBore, root, kTip);
    face.build(kThickness);
    ModelSurface surface = std::move(face.surface);
    const std::size_t top_count = surface.triangles.size();
    const int top_points = static_cast<int>(surface.points.size());
    for (int i = 0; i < top_points; ++i) {
        Vec3 below = surface.points[static_cast<std::size_t>(i)];
        below.z() = 0;
        surface.add(below);
    }
    for (std::size_t i = 0; i < top_count; ++i) {
        const auto [a, b, c] = surface.triangles[i];
        surface.add_triangle(a + top_points, c + top_points, b + top_points);
    }
    add_wall(surface, face.outline, options.resolution, true);
    add_wall(surface, face.hole, options.resolution, false);
    return surface;
}

namespace {

/// A flat flower: a lens whose outline has `count` petals. Valleys between petals are creases that
/// fade towards the middle; the outline is a sharp rim.
class Flower {
public:
    explicit Flower(int petal_count)
        : petal_count_(petal_count),
          notch_(1.6 / (petal_count + 1.6)),
          valley_(std::min(0.6, 3.0 / petal_count)) {}

    /// `part` runs from 0 in the middle to 1 at the rim; height is 0 at the rim.
    Vec3 point(double part, double petal_angle, double middle_angle) const {
        // 0 in the middle of a petal, 1 in a valley, with a kink there.
        const double depth = 1 - std::cos(0.5 * petal_count_ * petal_angle);
        const double grown = fade(part);
        const double radius = kRadius * part * (1 - notch_ * grown * depth);
        const double height = kHeight * (1 - part * part) * (1 - valley_ * grown * depth);
        const double angle = middle_angle + petal_angle;
        return {radius * std::cos(angle), radius * std::sin(angle), height};
    }

    static constexpr double kRadius = 0.5;
    static constexpr double kHeight = 0.2;

private:
    static double fade(double part) {
        const double t = std::clamp((part - kFlat) / (0.75 - kFlat), 0.0, 1.0);
        return t * t * (3 - 2 * t);
    }

    static constexpr double kFlat = 0.15;
    int petal_count_;
    // Shallower with more petals, so that the kink keeps its angle.
    double notch_, valley_;
};

}  // namespace

ModelSurface make_octaflower(const ModelOptions& options) {
    check_triangle_count(8 / (options.resolution * options.resolution));
    const Flower flower(options.count);
    const double half = kPi / options.count;
    ModelSurface surface;
    const int row_count =
        std::max(3, piece_count(1.2 * Flower::kRadius, kRowHeight * options.resolution));
    // Chains of one petal each, from valley to valley, outermost first.
    const auto add_chains = [&](int row, double side) {
        const double part = static_cast<double>(row) / row_count;
        const double length = 2 * half * Flower::kRadius * part;
        const int count = std::max(1, static_cast<int>(std::lround(length / options.resolution)));
        std::vector<Ring> chains(static_cast<std::size_t>(options.count));
        for (int petal = 0; petal < options.count; ++petal) {
            for (int i = 0; i < count; ++i) {
                const double angle = -half + 2 * half * i / count;
                Vec3 point = flower.point(part, angle, 2 * half * petal);
                point.z() *= side;
                chains[petal].push_back(surface.add(point));
            }
        }
        for (int petal = 0; petal < options.count; ++petal) {
            chains[petal].push_back(chains[(petal + 1) % options.count].front());
        }
        return chains;
    };
    const std::vector<Ring> rim = add_chains(row_count, 0);
    for (const double side : {1.0, -1.0}) {
        std::vector<Ring> outer = rim;
        int row = row_count - 1;
        // Petals that are narrower than half an edge have no crease left to follow.
        for (; row >= 1 && half * Flower::kRadius * row / row_count > 0.4 * options.resolution;
             --row) {
            std::vector<Ring> inner = add_chains(row, side);
            for (int petal = 0; petal < options.count; ++petal) {
                side > 0 ? surface.zip(outer[petal], inner[petal])
                         : surface.zip(reversed(outer[petal]), reversed(inner[petal]));
            }
            outer = std::move(inner);
        }
        Ring ring;
        for (const Ring& chain : outer) ring.insert(ring.end(), chain.begin(), chain.end() - 1);
        for (; row >= 1; --row) {
            const double part = static_cast<double>(row) / row_count;
            const double radius = Flower::kRadius * part;
            const double z = side * Flower::kHeight * (1 - part * part);
            const Ring inner =
                add_ring(surface, radius, z, ring_size(radius, options.resolution), 0.25);
            side > 0 ? surface.zip_rings(ring, inner)
                     : surface.zip_rings(reversed(ring), reversed(inner));
            ring = inner;
        }
        surface.cap(side > 0 ? ring : reversed(ring), {0, 0, side * Flower::kHeight});
    }
    return surface;
}

ModelSurface make_noisy_plane(const ModelOptions& options) {
    check_triangle_count(2.4 / (options.resolution * options.resolution));
    ModelSurface surface;
    const int column_count = piece_count(1, options.resolution);
    const int row_count = piece_count(1, kRowHeight * options.resolution);
    Ring lower;
    for (int row = 0; row <= row_count; ++row) {
        const double y = static_cast<double>(row) / row_count;
        Ring upper;
        // Every second row is shifted by half an edge and has half an edge at both ends.
        const bool is_shifted = row % 2 == 1;
        if (is_shifted) upper.push_back(surface.add({0, y, 0}));
        for (int i = 0; i < column_count + (is_shifted ? 0 : 1); ++i) {
            upper.push_back(surface.add({(i + (is_shifted ? 0.5 : 0)) / column_count, y, 0}));
        }
        if (is_shifted) upper.push_back(surface.add({1, y, 0}));
        if (row > 0) surface.zip(lower, upper);
        lower = upper;
    }
    return surface;
}

}  // namespace fcn
