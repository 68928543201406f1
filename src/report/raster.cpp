// Triangles to pixels: edge functions over bounding boxes (Pineda 1988) with a z-buffer. Faces are
// sorted into bands of rows, each band is filled by one task in the order of the faces, so equal
// depths resolve the same way on any number of threads. Ambient occlusion is estimated on the
// finished depth buffer (screen-space, after Mittring 2007): a neighbour occludes as far as it
// rises above the tangent plane of the pixel; the tangent plane, where the original uses the depth
// alone, keeps slanted planes from darkening.
#include "report/raster.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fcn {
namespace {

constexpr int kBandRows = 32;
constexpr double kCreaseCosine = 0.8191520442889918;  ///< cos 35 degrees

using CornerNormals = std::array<Eigen::Vector3f, 3>;

/// Per face and corner: the mean normal of the vertex's faces that bend little against this one.
std::vector<CornerNormals> corner_normals(const Mesh& mesh, const Projection& projection) {
    std::vector<Vec3> unit(mesh.n_faces());
    std::vector<double> area(mesh.n_faces());
    tbb::parallel_for(std::size_t{0}, mesh.n_faces(), [&](std::size_t i) {
        const FaceHandle face(static_cast<int>(i));
        unit[i] = face_normal(mesh, face);
        area[i] = face_area(mesh, face);
    });
    std::vector<CornerNormals> normals(mesh.n_faces());
    tbb::parallel_for(std::size_t{0}, mesh.n_faces(), [&](std::size_t i) {
        const auto vertices = face_vertices(mesh, FaceHandle(static_cast<int>(i)));
        for (int corner = 0; corner < 3; ++corner) {
            Vec3 sum = Vec3::Zero();
            for (const FaceHandle other : mesh.vf_range(vertices[corner])) {
                const auto j = static_cast<std::size_t>(other.idx());
                if (unit[j].dot(unit[i]) >= kCreaseCosine) sum += area[j] * unit[j];
            }
            if (!(sum.norm() > 0)) sum = unit[i];
            const Vec3 view = projection.direction(sum.normalized());
            normals[i][static_cast<std::size_t>(corner)] = view.cast<float>();
        }
    });
    return normals;
}

struct ScreenFace {
    std::array<Eigen::Vector3d, 3> corner;  ///< pixels, depth
    int index = 0;
};

double twice_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

void put_pixel(Raster& raster, std::size_t pixel, const ScreenFace& face,
               const CornerNormals& normals, const Eigen::Vector3d& weight,
               const Eigen::Vector3d& altitude) {
    const double depth = weight[0] * face.corner[0][2] + weight[1] * face.corner[1][2] +
                         weight[2] * face.corner[2][2];
    if (!(static_cast<float>(depth) > raster.depth[pixel])) return;
    raster.depth[pixel] = static_cast<float>(depth);
    Eigen::Vector3f normal = static_cast<float>(weight[0]) * normals[0] +
                             static_cast<float>(weight[1]) * normals[1] +
                             static_cast<float>(weight[2]) * normals[2];
    const float length = normal.norm();
    normal = length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f(0, 0, 1);
    raster.normal[pixel] = normal;
    if (raster.edge_distance.empty()) return;
    raster.edge_distance[pixel] = static_cast<float>(weight.cwiseProduct(altitude).minCoeff());
    raster.edge_length[pixel] = static_cast<float>(altitude.minCoeff());
}

void fill_face(Raster& raster, const ScreenFace& face, const CornerNormals& normals, int first_row,
               int last_row) {
    const auto& [a, b, c] = face.corner;
    const double area = twice_area(a, b, c[0], c[1]);
    if (!(std::abs(area) > 1e-12)) return;
    const Eigen::Vector3d altitude =
        std::abs(area) * Eigen::Vector3d(1 / (c - b).head<2>().norm(), 1 / (a - c).head<2>().norm(),
                                         1 / (b - a).head<2>().norm());
    const auto first_pixel = [](double v) { return static_cast<int>(std::ceil(v - 0.5)); };
    const auto last_pixel = [](double v) { return static_cast<int>(std::floor(v - 0.5)); };
    const int x0 = std::max(0, first_pixel(std::min({a[0], b[0], c[0]})));
    const int x1 = std::min(raster.width - 1, last_pixel(std::max({a[0], b[0], c[0]})));
    const int y0 = std::max(first_row, first_pixel(std::min({a[1], b[1], c[1]})));
    const int y1 = std::min(last_row, last_pixel(std::max({a[1], b[1], c[1]})));
    const bool is_back = area > 0;  // y runs down: counter-clockwise faces have negative area
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            const double px = x + 0.5, py = y + 0.5;
            const Eigen::Vector3d weight(twice_area(b, c, px, py) / area,
                                         twice_area(c, a, px, py) / area,
                                         twice_area(a, b, px, py) / area);
            if (weight.minCoeff() < 0) continue;
            const std::size_t pixel = raster.index(x, y);
            const float before = raster.depth[pixel];
            put_pixel(raster, pixel, face, normals, weight, altitude);
            if (raster.depth[pixel] == before) continue;
            raster.is_back[pixel] = is_back;
            if (is_back) raster.normal[pixel] = -raster.normal[pixel];
        }
    }
}

/// Indices of the faces that touch each band of rows, ascending.
std::vector<std::vector<int>> faces_by_band(const std::vector<ScreenFace>& faces, int height) {
    std::vector<std::vector<int>> bands(
        static_cast<std::size_t>((height + kBandRows - 1) / kBandRows));
    for (const ScreenFace& face : faces) {
        const auto [low, high] =
            std::minmax({face.corner[0][1], face.corner[1][1], face.corner[2][1]});
        const int first = std::max(0, static_cast<int>(std::floor(low)));
        const int last = std::min(height - 1, static_cast<int>(std::ceil(high)));
        for (int band = first / kBandRows; band <= last / kBandRows && first <= last; ++band)
            bands[static_cast<std::size_t>(band)].push_back(face.index);
    }
    return bands;
}

Raster empty_raster(int width, int height, bool is_wireframe) {
    Raster raster;
    raster.width = width;
    raster.height = height;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    raster.depth.assign(pixels, -std::numeric_limits<float>::infinity());
    raster.normal.assign(pixels, Eigen::Vector3f::Zero());
    raster.is_back.assign(pixels, 0);
    if (is_wireframe) {
        raster.edge_distance.assign(pixels, std::numeric_limits<float>::infinity());
        raster.edge_length.assign(pixels, 0);
    }
    return raster;
}

}  // namespace

Raster rasterize(const Mesh& mesh, const Projection& projection, int width, int height,
                 bool is_wireframe) {
    Raster raster = empty_raster(width, height, is_wireframe);
    const std::vector<CornerNormals> normals = corner_normals(mesh, projection);
    std::vector<ScreenFace> faces(mesh.n_faces());
    tbb::parallel_for(std::size_t{0}, mesh.n_faces(), [&](std::size_t i) {
        const auto vertices = face_vertices(mesh, FaceHandle(static_cast<int>(i)));
        faces[i].index = static_cast<int>(i);
        for (std::size_t corner = 0; corner < 3; ++corner)
            faces[i].corner[corner] = projection(mesh.point(vertices[corner]));
    });
    const auto bands = faces_by_band(faces, height);
    tbb::parallel_for(std::size_t{0}, bands.size(), [&](std::size_t band) {
        const int first = static_cast<int>(band) * kBandRows;
        const int last = std::min(height, first + kBandRows) - 1;
        for (const int face : bands[band]) {
            const auto i = static_cast<std::size_t>(face);
            fill_face(raster, faces[i], normals[i], first, last);
        }
    });
    return raster;
}

std::vector<float> ambient_occlusion(const Raster& raster, double pixels_per_unit) {
    constexpr int kDirections = 12, kRings = 2;
    const double reach = 0.035 * std::hypot(raster.width, raster.height);
    struct Offset {
        int x, y;
        float distance;  ///< pixels
    };
    std::vector<Offset> offsets;
    for (int ring = 1; ring <= kRings; ++ring) {
        for (int k = 0; k < kDirections; ++k) {
            const double angle = (k + 0.5 * ring) * 2 * 3.14159265358979323846 / kDirections;
            const double radius = reach * std::pow(static_cast<double>(ring) / kRings, 1.5);
            const int x = static_cast<int>(std::lround(radius * std::cos(angle)));
            const int y = static_cast<int>(std::lround(radius * std::sin(angle)));
            if (x != 0 || y != 0) offsets.push_back({x, y, static_cast<float>(std::hypot(x, y))});
        }
    }
    std::vector<float> open(raster.depth.size(), 1);
    const auto scale = static_cast<float>(pixels_per_unit);
    tbb::parallel_for(0, raster.height, [&](int y) {
        for (int x = 0; x < raster.width; ++x) {
            const std::size_t pixel = raster.index(x, y);
            if (!std::isfinite(raster.depth[pixel])) continue;
            const Eigen::Vector3f& n = raster.normal[pixel];
            const float slope = 1 / std::max(n[2], 0.25F);
            float occluded = 0;
            for (const Offset& offset : offsets) {
                const int u = x + offset.x, v = y + offset.y;
                if (u < 0 || v < 0 || u >= raster.width || v >= raster.height) continue;
                const float depth = raster.depth[raster.index(u, v)];
                if (!std::isfinite(depth)) continue;
                // Screen y runs down, camera y up.
                const float plane =
                    -(n[0] * static_cast<float>(offset.x) - n[1] * static_cast<float>(offset.y)) *
                    slope;
                const float rise = (depth - raster.depth[pixel]) * scale - plane;
                const float relative = rise / offset.distance - 0.08F;
                if (relative <= 0 || relative > 4) continue;  // far in front: another object
                occluded += std::min(relative, 1.0F) * (1 - relative / 4);
            }
            open[pixel] = 1 - occluded / static_cast<float>(offsets.size());
        }
    });
    return open;
}

}  // namespace fcn
