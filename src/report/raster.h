#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/mesh.h"
#include "report/camera.h"

namespace fcn {

/// What the eye sees through each pixel of a z-buffer.
struct Raster {
    int width = 0, height = 0;
    std::vector<float> depth;             ///< world units toward the eye; -infinity: background
    std::vector<Eigen::Vector3f> normal;  ///< unit, camera axes, toward the eye
    std::vector<float> edge_distance;     ///< pixels to the nearest edge of the face; wireframe
    std::vector<float> edge_length;       ///< shortest altitude of the face, pixels; wireframe
    std::vector<std::uint8_t> is_back;    ///< seen from behind (open meshes)

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// Rasterises all faces; parallel over bands of rows, the result independent of the threads.
/// Normals are smooth across edges of less than 35 degrees and break at sharper ones.
Raster rasterize(const Mesh& mesh, const Projection& projection, int width, int height,
                 bool is_wireframe);

/// Share of the sky that each pixel sees, [0, 1]; 1 = open.
std::vector<float> ambient_occlusion(const Raster& raster, double pixels_per_unit);

}  // namespace fcn
