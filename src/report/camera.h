#pragma once

#include "geometry/mesh.h"

namespace fcn {

/// Where the eye is: `toward` points from the mesh to the eye; right, up, toward are orthonormal.
struct CameraFrame {
    Vec3 right = Vec3::UnitX();
    Vec3 up = Vec3::UnitY();
    Vec3 toward = Vec3::UnitZ();
};

/// A view that shows much of the mesh: a three-quarter view, for flat objects onto their largest
/// extent. Depends on the mesh alone. O(faces).
CameraFrame choose_camera(const Mesh& mesh);

/// The frame of a given direction to the eye; `up` is made orthogonal, zero or parallel to `view`
/// chooses one. Throws InputError unless view is finite and not zero.
CameraFrame make_camera(const Vec3& view, const Vec3& up);

/// Orthographic projection: world units to pixels, y down, depth growing toward the eye.
class Projection {
public:
    /// Fits the mesh into width x height pixels with a margin.
    Projection(const CameraFrame& frame, const Mesh& mesh, double width, double height);

    /// x, y in pixels, z = depth in world units.
    Vec3 operator()(const Vec3& point) const;
    Vec3 direction(const Vec3& vector) const;  ///< in camera axes (right, up, toward)
    double pixels_per_unit() const { return scale_; }

private:
    CameraFrame frame_;
    double center_x_ = 0, center_y_ = 0;  ///< in camera axes
    double half_width_ = 0, half_height_ = 0;
    double scale_ = 1;
};

}  // namespace fcn
