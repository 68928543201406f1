// Quality of quad meshes. The scaled Jacobian is that of Knupp 2000 for a flat quad; a quad that is
// not flat is seen along its area vector. Alignment asks in which quad a point of a curve lies and
// how its parameter lines run there; a point on an edge between two quads is the same in both, so
// that a mesh with the curves as edges has 0 up to the curves' own bends.
#include "meshing/quad_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <unordered_map>

#include "geometry/errors.h"
#include "meshing/quad_shape.h"
#include "meshing/reference_surface.h"

namespace fcn {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

QuadCorners corners_of(const QuadMesh& mesh, std::size_t face) {
    QuadCorners quad;
    for (std::size_t i = 0; i < 4; ++i) quad[i] = mesh.points[at(mesh.faces[face][i])];
    return quad;
}

void measure_shapes(const QuadMesh& mesh, QuadQuality& quality) {
    quality.min_scaled_jacobian = 1;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const QuadCorners quad = corners_of(mesh, f);
        const Vec3 area = area_vector(quad);
        const double norm = area.norm();
        const auto sines = corner_sines(quad, norm > 0 ? Vec3(area / norm) : Vec3::Zero());
        double least = 1;
        for (const double sine : sines) {
            least = std::min(least, sine);
            quality.inverted_corners += sine <= 0;
        }
        quality.mean_scaled_jacobian += least / static_cast<double>(mesh.faces.size());
        quality.min_scaled_jacobian = std::min(quality.min_scaled_jacobian, least);
    }
}

void measure_edge_lengths(const QuadMesh& mesh, const std::vector<int>& opposite,
                          QuadQuality& quality) {
    double sum = 0, count = 0;
    quality.min_edge = std::numeric_limits<double>::infinity();
    for (int h = 0; h < static_cast<int>(opposite.size()); ++h) {
        if (opposite[at(h)] > h) continue;
        const auto& face = mesh.faces[at(h / 4)];
        const double length =
            (mesh.points[at(face[at(h + 1) % 4])] - mesh.points[at(face[at(h) % 4])]).norm();
        quality.min_edge = std::min(quality.min_edge, length);
        quality.max_edge = std::max(quality.max_edge, length);
        sum += length;
        ++count;
    }
    quality.mean_edge = sum / count;
}

/// Pairs of points closer than `distance`, by a grid of cells of that size.
std::size_t count_close_pairs(const std::vector<Vec3>& points, double distance) {
    using Cell = std::array<std::int64_t, 3>;
    struct Hash {
        std::size_t operator()(const Cell& c) const {
            return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
        }
    };
    std::unordered_map<Cell, std::vector<const Vec3*>, Hash> cells;
    const auto cell_of = [&](const Vec3& p) {
        Cell cell;
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor(p[static_cast<int>(k)] / distance));
        return cell;
    };
    std::size_t count = 0;
    for (const Vec3& p : points) {
        const Cell own = cell_of(p);
        for (std::int64_t k = 0; k < 27; ++k) {
            const Cell near{own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1};
            const auto found = cells.find(near);
            if (found == cells.end()) continue;
            for (const Vec3* other : found->second) count += (*other - p).norm() < distance;
        }
        cells[own].push_back(&p);
    }
    return count;
}

/// Per vertex the quads around it; 0 at the boundary.
std::vector<int> inner_valences(const QuadMesh& mesh, const std::vector<int>& opposite) {
    std::vector<int> valence(mesh.points.size(), 0);
    for (const auto& face : mesh.faces)
        for (const int v : face) ++valence[at(v)];
    for (int h = 0; h < static_cast<int>(opposite.size()); ++h) {
        if (opposite[at(h)] >= 0) continue;
        const auto& face = mesh.faces[at(h / 4)];
        valence[at(face[at(h) % 4])] = valence[at(face[at(h + 1) % 4])] = 0;
    }
    return valence;
}

void measure_singularities(const QuadMesh& mesh, const std::vector<int>& opposite,
                           double edge_length, QuadQuality& quality) {
    std::vector<Vec3> irregular;
    const std::vector<int> valence = inner_valences(mesh, opposite);
    for (std::size_t v = 0; v < valence.size(); ++v) {
        quality.inner_vertices += valence[v] > 0;
        if (valence[v] > 0 && valence[v] != 4) irregular.push_back(mesh.points[v]);
    }
    if (quality.inner_vertices > 0)
        quality.share_irregular =
            static_cast<double>(irregular.size()) / static_cast<double>(quality.inner_vertices);
    if (edge_length > 0) quality.close_singularities = count_close_pairs(irregular, edge_length);
}

/// The directions of the parameter lines of a quad at the point nearest to `p`.
std::array<Vec3, 2> directions_at(const QuadCorners& q, const Vec3& p) {
    double u = 0.5, v = 0.5;
    const auto along_u = [&] { return Vec3((1 - v) * (q[1] - q[0]) + v * (q[2] - q[3])); };
    const auto along_v = [&] { return Vec3((1 - u) * (q[3] - q[0]) + u * (q[2] - q[1])); };
    for (int step = 0; step < 6; ++step) {  // Gauss and Newton
        const Vec3 at_uv =
            (1 - u) * (1 - v) * q[0] + u * (1 - v) * q[1] + u * v * q[2] + (1 - u) * v * q[3];
        const Vec3 a = along_u(), b = along_v(), off = p - at_uv;
        const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b);
        const double determinant = aa * bb - ab * ab;
        if (!(determinant > 1e-12 * aa * bb)) break;
        u = std::clamp(u + (bb * off.dot(a) - ab * off.dot(b)) / determinant, 0.0, 1.0);
        v = std::clamp(v + (aa * off.dot(b) - ab * off.dot(a)) / determinant, 0.0, 1.0);
    }
    return {along_u(), along_v()};
}

class AlignmentMeter {
public:
    explicit AlignmentMeter(const QuadMesh& mesh) : mesh_(mesh), surface_(triangles(mesh)) {}

    void add(const Vec3& from, const Vec3& to, double spacing) {
        const Vec3 along = to - from;
        const double length = along.norm();
        if (!(length > 0)) return;
        const int count = std::max(1, static_cast<int>(std::ceil(length / spacing)));
        for (int i = 0; i < count; ++i) {
            const Vec3 p = from + (i + 0.5) / count * along;
            const ReferencePoint near =
                surface_.closest(p, Vec3::Zero(), std::numeric_limits<double>::max(), -1);
            const double angle =
                angle_in(corners_of(mesh_, at(near.face / 2)), near.position, along);
            result_.max_degrees = std::max(result_.max_degrees, angle);
            const double weight = length / count;
            result_.mean_degrees += weight * angle;
            result_.share_over_10 += angle > 10 ? weight : 0;
            length_ += weight;
            ++result_.samples;
        }
    }

    QuadAlignment result() const {
        QuadAlignment result = result_;
        if (length_ > 0) {
            result.mean_degrees /= length_;
            result.share_over_10 /= length_;
        }
        return result;
    }

private:
    static std::vector<std::array<Vec3, 3>> triangles(const QuadMesh& mesh) {
        std::vector<std::array<Vec3, 3>> result;
        for (const auto& [a, b, c] : cut_into_triangles(mesh))
            result.push_back({mesh.points[at(a)], mesh.points[at(b)], mesh.points[at(c)]});
        return result;
    }

    /// In the quad's plane; a direction across it counts as 45 degrees.
    static double angle_in(const QuadCorners& quad, const Vec3& p, const Vec3& direction) {
        const Vec3 normal = area_vector(quad).normalized();
        const Vec3 flat = direction - normal.dot(direction) * normal;
        double least = 45;
        for (const Vec3& d : directions_at(quad, p)) {
            const Vec3 line = d - normal.dot(d) * normal;
            const double angle =
                std::atan2(flat.cross(line).norm(), std::abs(flat.dot(line))) * kDegreesPerRadian;
            if (flat.norm() > 1e-9 * direction.norm()) least = std::min(least, angle);
        }
        return least;
    }

    const QuadMesh& mesh_;
    ReferenceSurface surface_;
    QuadAlignment result_;
    double length_ = 0;
};

}  // namespace

QuadQuality measure_quads(const QuadMesh& mesh, double edge_length) {
    QuadQuality quality;
    quality.vertices = mesh.points.size();
    quality.faces = mesh.faces.size();
    if (mesh.faces.empty()) return quality;
    measure_shapes(mesh, quality);
    const std::vector<int> opposite = opposite_halfedges(mesh);
    measure_edge_lengths(mesh, opposite, quality);
    measure_singularities(mesh, opposite, edge_length, quality);
    return quality;
}

std::vector<IrregularVertex> irregular_vertices(const QuadMesh& mesh) {
    std::vector<IrregularVertex> result;
    const std::vector<int> valence = inner_valences(mesh, opposite_halfedges(mesh));
    for (std::size_t v = 0; v < valence.size(); ++v)
        if (valence[v] > 0 && valence[v] != 4) result.push_back({static_cast<int>(v), valence[v]});
    return result;
}

QuadAlignment measure_alignment(const QuadMesh& mesh, const FeatureCurveNetwork& network,
                                double sample_spacing) {
    if (mesh.faces.empty()) throw InputError("measure: a mesh without faces has no directions");
    if (!(sample_spacing > 0) || !std::isfinite(sample_spacing))
        throw InputError("measure: sample spacing must be > 0, it is " +
                         std::to_string(sample_spacing));
    AlignmentMeter meter(mesh);
    for (const NetworkSegment& segment : network.segments)
        meter.add(network.nodes.at(at(segment.nodes[0])).position,
                  network.nodes.at(at(segment.nodes[1])).position, sample_spacing);
    if (network.segments.empty())
        for (const NetworkArc& arc : network.arcs)
            for (std::size_t i = 1; i < arc.samples.size(); ++i)
                meter.add(arc.samples[i - 1].position, arc.samples[i].position, sample_spacing);
    return meter.result();
}

}  // namespace fcn
