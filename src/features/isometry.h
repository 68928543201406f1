#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// x -> linear * x + translation, with an orthogonal linear part.
struct Isometry {
    Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator()(const Vec3& point) const { return linear * point + translation; }
    Isometry inverse() const { return {linear.transpose(), -(linear.transpose() * translation)}; }
    /// First `first`, then this.
    Isometry after(const Isometry& first) const {
        return {linear * first.linear, linear * first.translation + translation};
    }
    bool is_improper() const { return linear.determinant() < 0; }
};

/// Isometries that a shape can have as symmetries of its own. Screws, glides and
/// rotoreflections are none of them.
enum class SymmetryKind { Reflection, Rotation, Translation };

/// Largest distance between the images of a point under both, over a ball of `radius` about
/// `center`, up to a factor of two.
double displacement_between(const Isometry& a, const Isometry& b, const Vec3& center,
                            double radius);

/// Proper (rotation and translation) or improper isometry that maps `from[k]` to `to[k]` with the
/// least sum of squares (Kabsch 1976). At least one pair.
Isometry fit_isometry(const std::vector<Vec3>& from, const std::vector<Vec3>& to, bool is_improper);

/// The same among the isometries of one kind; `kind_of(guess)` says which. A rotation keeps the
/// axis direction of the best proper isometry and loses its shift along the axis.
Isometry fit_symmetry(SymmetryKind kind, const std::vector<Vec3>& from,
                      const std::vector<Vec3>& to);

/// Which kind an isometry is when deviations of up to `tolerance` inside the ball do not count.
/// Nothing for the identity and for what is none of the kinds.
std::optional<SymmetryKind> kind_of(const Isometry& map, const Vec3& center, double radius,
                                    double tolerance);

/// The part `share` (0 to 1) of a proper isometry's screw motion.
Isometry part_of_motion(const Isometry& motion, double share);

/// The reflection that exchanges two different points.
Isometry reflection_between(const Vec3& a, const Vec3& b);

}  // namespace fcn
