// Best isometries between point sets: Kabsch's singular vectors for proper and improper ones; for
// reflections x -> x - 2 n (n.x - d) the sum of squares is least when n is the eigenvector of the
// least eigenvalue of the symmetrised cross-covariance and the plane passes through the mean of
// both centroids.

#include "features/isometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace fcn {

namespace {

Vec3 mean(const std::vector<Vec3>& points) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& point : points) sum += point;
    return sum / static_cast<double>(points.size());
}

Eigen::Matrix3d cross_covariance(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                 const Vec3& from_mean, const Vec3& to_mean) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < from.size(); ++k)
        sum += (to[k] - to_mean) * (from[k] - from_mean).transpose();
    return sum;
}

/// Axis of a rotation matrix, unit length; any unit vector for the identity.
Vec3 rotation_axis(const Eigen::Matrix3d& rotation) {
    return Eigen::AngleAxisd(Eigen::Quaterniond(rotation).normalized()).axis();
}

Isometry reflection_in(const Vec3& normal, double offset) {
    return {Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose(), 2 * offset * normal};
}

}  // namespace

double displacement_between(const Isometry& a, const Isometry& b, const Vec3& center,
                            double radius) {
    return (a(center) - b(center)).norm() + radius * (a.linear - b.linear).norm();
}

Isometry fit_isometry(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                      bool is_improper) {
    const Vec3 from_mean = mean(from);
    const Vec3 to_mean = mean(to);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross_covariance(from, to, from_mean, to_mean),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() > 0 ? 1 : -1;
    const Vec3 diagonal(1, 1, is_improper ? -sign : sign);
    Isometry map;
    map.linear = svd.matrixU() * diagonal.asDiagonal() * svd.matrixV().transpose();
    map.translation = to_mean - map.linear * from_mean;
    return map;
}

Isometry fit_symmetry(SymmetryKind kind, const std::vector<Vec3>& from,
                      const std::vector<Vec3>& to) {
    const Vec3 from_mean = mean(from);
    const Vec3 to_mean = mean(to);
    if (kind == SymmetryKind::Translation)
        return {Eigen::Matrix3d::Identity(), to_mean - from_mean};
    if (kind == SymmetryKind::Reflection) {
        // Centroids that the plane must exchange count as one more pair of points.
        const Vec3 between = (to_mean - from_mean) / 2;
        Eigen::Matrix3d sum = cross_covariance(from, to, from_mean, to_mean);
        sum -= static_cast<double>(from.size()) * between * between.transpose();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
            Eigen::Matrix3d((sum + sum.transpose()) / 2));
        const Vec3 normal = solver.eigenvectors().col(0);
        return reflection_in(normal, normal.dot(from_mean + to_mean) / 2);
    }
    Isometry map = fit_isometry(from, to, false);
    const Vec3 axis = rotation_axis(map.linear);
    map.translation -= axis * axis.dot(map.translation);
    return map;
}

std::optional<SymmetryKind> kind_of(const Isometry& map, const Vec3& center, double radius,
                                    double tolerance) {
    if (displacement_between(map, {}, center, radius) <= tolerance) return {};
    Isometry pure;
    SymmetryKind kind = SymmetryKind::Translation;
    if (map.is_improper()) {
        kind = SymmetryKind::Reflection;
        const Vec3 normal = rotation_axis(-map.linear);
        pure = reflection_in(normal, normal.dot(center + map(center)) / 2);
    } else {
        pure.translation = map(center) - center;
        if (displacement_between(map, pure, center, radius) > tolerance) {
            kind = SymmetryKind::Rotation;
            const Vec3 axis = rotation_axis(map.linear);
            pure = map;
            pure.translation -= axis * axis.dot(map.translation);
        }
    }
    if (displacement_between(map, pure, center, radius) > tolerance) return {};
    return kind;
}

Isometry part_of_motion(const Isometry& motion, double share) {
    const Eigen::AngleAxisd turn(Eigen::Quaterniond(motion.linear).normalized());
    const double half_sine = std::sin(turn.angle() / 2);
    if (std::abs(half_sine) < 1e-9)
        return {Eigen::Matrix3d::Identity(), share * motion.translation};
    const Vec3& axis = turn.axis();
    const Vec3 along = axis * axis.dot(motion.translation);
    const Vec3 across = motion.translation - along;
    const double cotangent = std::cos(turn.angle() / 2) / half_sine;
    const Vec3 center = (across + cotangent * axis.cross(across)) / 2;  // of the turn
    Isometry part;
    part.linear = Eigen::AngleAxisd(share * turn.angle(), axis).toRotationMatrix();
    part.translation = share * along + center - part.linear * center;
    return part;
}

Isometry reflection_between(const Vec3& a, const Vec3& b) {
    const Vec3 normal = (b - a).normalized();
    return reflection_in(normal, normal.dot(a + b) / 2);
}

}  // namespace fcn
