#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

struct Color {
    std::uint8_t r = 0, g = 0, b = 0;
};

/// Curves drawn on top of the mesh where the surface does not hide them.
struct PictureLayer {
    std::vector<std::vector<Vec3>> polylines;
    Color color;
    double width = 2;  ///< pixels
};

struct PictureOptions {
    int width = 900, height = 700;  ///< pixels
    /// Camera direction (from the mesh to the eye) and up; zero = chosen from the mesh.
    Vec3 view = Vec3::Zero();
    Vec3 up = Vec3::Zero();
    /// Mesh that is framed, and whose view is chosen, instead of the drawn one; not owned.
    const Mesh* seen_as = nullptr;
    bool is_drawing_wireframe = false;
    Color surface{214, 219, 226};
};

/// Renders with a z-buffer (shaded, hidden lines removed, 2x2 supersampled) to PNG bytes.
/// Deterministic.
std::string render_png(const Mesh& mesh, const std::vector<PictureLayer>& layers,
                       const PictureOptions& options = {});

}  // namespace fcn
