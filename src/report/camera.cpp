// The view is chosen among a fixed set of directions by viewpoint entropy (Vazquez, Feixas,
// Sbert, Heidrich 2001): a view is good if the projected area is spread evenly over many different
// parts of the object. We measure over bins of equal normals instead of over faces, so that the
// answer does not depend on the tessellation, and ignore occlusion, so that all candidates together
// cost one pass over the faces. The vertical is the coordinate axis the object stands on.
#include "report/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr int kBinsPerAxis = 9;   ///< odd: the coordinate planes fall into bin centres
constexpr double kMargin = 0.05;  ///< of the picture, free on every side
constexpr double kFlat = 0.25;    ///< an extent below this share of the second largest is thin

std::vector<Vec3> binned_normals(const Mesh& mesh) {
    std::vector<Vec3> bins(kBinsPerAxis * kBinsPerAxis * kBinsPerAxis, Vec3::Zero());
    for (const FaceHandle face : mesh.faces()) {
        const Vec3 normal = face_normal(mesh, face);
        std::size_t bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int cell = static_cast<int>(std::floor((normal[axis] + 1) / 2 * kBinsPerAxis));
            bin = bin * kBinsPerAxis +
                  static_cast<std::size_t>(std::clamp(cell, 0, kBinsPerAxis - 1));
        }
        bins[bin] += face_area(mesh, face) * normal;
    }
    std::erase_if(bins, [](const Vec3& bin) { return bin.isZero(0); });
    return bins;
}

/// Area of faces that look along -axis (or +axis) at the very end of the box: what it stands on.
double base_area(const Mesh& mesh, const BoundingBox& box, int axis) {
    const double floor = box.min[axis] + 0.02 * (box.max[axis] - box.min[axis]);
    double area = 0;
    for (const FaceHandle face : mesh.faces()) {
        if (face_normal(mesh, face)[axis] > -0.95) continue;
        if (mesh.point(face_vertices(mesh, face)[0])[axis] <= floor) area += face_area(mesh, face);
    }
    return area;
}

int thin_axis(const Vec3& extent) {
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return extent[a] < extent[b]; });
    return extent[order[0]] < kFlat * extent[order[1]] ? order[0] : -1;
}

int vertical_axis(const Mesh& mesh, const BoundingBox& box) {
    const Vec3 extent = box.max - box.min;
    const int thin = thin_axis(extent);
    if (thin >= 0) return thin;
    const double y_share = base_area(mesh, box, 1) / std::max(extent[0] * extent[2], 1e-300);
    const double z_share = base_area(mesh, box, 2) / std::max(extent[0] * extent[1], 1e-300);
    return z_share > std::max(y_share, 0.05) ? 2 : 1;
}

/// Entropy of the front-facing normals' projected areas, plus the share of area seen.
double view_score(const std::vector<Vec3>& bins, const Vec3& toward) {
    double seen = 0, total = 0;
    for (const Vec3& bin : bins) {
        seen += std::max(0.0, bin.dot(toward));
        total += bin.norm();
    }
    if (!(seen > 0)) return 0;
    double entropy = 0;
    for (const Vec3& bin : bins) {
        const double share = std::max(0.0, bin.dot(toward)) / seen;
        if (share > 0) entropy -= share * std::log(share);
    }
    return entropy + 4 * seen / total;
}

Vec3 direction(int vertical, double azimuth, double elevation) {
    Vec3 toward = Vec3::Zero();
    toward[vertical] = std::sin(elevation);
    toward[(vertical + 1) % 3] = std::cos(elevation) * std::cos(azimuth);
    toward[(vertical + 2) % 3] = std::cos(elevation) * std::sin(azimuth);
    return toward;
}

}  // namespace

CameraFrame make_camera(const Vec3& view, const Vec3& up) {
    if (!view.allFinite() || !up.allFinite() || view.isZero(0))
        throw InputError("picture: the view direction must be finite and not zero");
    CameraFrame frame;
    frame.toward = view.normalized();
    Vec3 right = up.cross(frame.toward);
    if (right.norm() < 1e-9 * std::max(up.norm(), 1e-300)) right = Vec3::Zero();
    if (right.isZero(0)) {
        int axis = 0;
        frame.toward.cwiseAbs().minCoeff(&axis);
        right = Vec3::Unit(axis).cross(frame.toward);
    }
    frame.right = right.normalized();
    frame.up = frame.toward.cross(frame.right);
    return frame;
}

CameraFrame choose_camera(const Mesh& mesh) {
    if (mesh.n_faces() == 0) return {};
    const BoundingBox box = bounding_box(mesh);
    const int vertical = vertical_axis(mesh, box);
    const bool is_flat = thin_axis(box.max - box.min) >= 0;
    const std::vector<Vec3> bins = binned_normals(mesh);

    constexpr double kDegree = 0.017453292519943295;
    const std::vector<double> elevations =
        is_flat ? std::vector<double>{45, 55} : std::vector<double>{18, 28};
    double best_score = -1;
    Vec3 best = Vec3::UnitZ();
    for (const double elevation : elevations) {
        for (int azimuth = 30; azimuth < 390; azimuth += 30) {
            if (azimuth % 90 == 0) continue;  // straight on: no three-quarter view
            const Vec3 toward = direction(vertical, azimuth * kDegree, elevation * kDegree);
            const double score = view_score(bins, toward);
            if (score > best_score + 1e-9) {
                best_score = score;
                best = toward;
            }
        }
    }
    return make_camera(best, Vec3::Unit(vertical));
}

Projection::Projection(const CameraFrame& frame, const Mesh& mesh, double width, double height)
    : frame_(frame), half_width_(width / 2), half_height_(height / 2) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double left = kInfinity, right = -kInfinity, bottom = kInfinity, top = -kInfinity;
    for (const VertexHandle vertex : mesh.vertices()) {
        const double x = mesh.point(vertex).dot(frame_.right);
        const double y = mesh.point(vertex).dot(frame_.up);
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = std::min(bottom, y);
        top = std::max(top, y);
    }
    if (mesh.n_vertices() == 0) return;
    center_x_ = (left + right) / 2;
    center_y_ = (bottom + top) / 2;
    const double free = 1 - 2 * kMargin;
    const double tiny = std::numeric_limits<double>::min();
    scale_ = std::min(width * free / std::max(right - left, tiny),
                      height * free / std::max(top - bottom, tiny));
    if (!std::isfinite(scale_)) scale_ = 1;  // a single point
}

Vec3 Projection::operator()(const Vec3& point) const {
    return {half_width_ + scale_ * (point.dot(frame_.right) - center_x_),
            half_height_ - scale_ * (point.dot(frame_.up) - center_y_), point.dot(frame_.toward)};
}

Vec3 Projection::direction(const Vec3& vector) const {
    return {vector.dot(frame_.right), vector.dot(frame_.up), vector.dot(frame_.toward)};
}

}  // namespace fcn
