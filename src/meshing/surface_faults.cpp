// What a finished remesh can still be faulted for: sheets that cross, small angles, and protrusions
// that are cut off (the distance from the reference to the mesh, which no step before looks at:
// they see to it that the mesh lies on the reference, not that it covers it).
#include "meshing/surface_faults.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshing/forced_angles.h"
#include "meshing/self_intersections.h"
#include "meshing/triangle_shape.h"

namespace fcn {
namespace {

constexpr double kCreaseCosine = 0.9659258262890683;  ///< 15 degrees
constexpr double kSmallAngle = 0.5235987755982988;    ///< 30 degrees
constexpr double kFar = 0.4;                          ///< in targets
constexpr double kMostNeedles = 0.05;                 ///< of the faces
constexpr double kFewNeedles = 40;
constexpr double kWellInside = 2;  ///< in targets: limits of samples with all faces near them
constexpr double kOut = 100;       ///< in targets: no nearest point is looked for

std::array<Vec3, 3> points_of(const WorkingMesh& mesh, int face) {
    const auto [a, b, c] = mesh.corners(face);
    return {mesh.point(a), mesh.point(b), mesh.point(c)};
}

Vec3 normal_of(const Mesh& mesh, FaceHandle face) {
    const auto v = face_vertices(mesh, face);
    return triangle_normal(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]));
}

void add_crease_points(const Mesh& mesh, EdgeHandle edge, double spacing,
                       std::vector<SurfaceSample>& samples) {
    const double count = std::ceil(mesh.calc_edge_length(edge) / spacing);
    if (!(count > 1) || !(count < 1e6)) return;
    const HalfedgeHandle h = mesh.halfedge_handle(edge, 0);
    const FaceHandle one = mesh.face_handle(h);
    const FaceHandle other = mesh.face_handle(mesh.opposite_halfedge_handle(h));
    if (one.is_valid() && other.is_valid() &&
        normal_of(mesh, one).dot(normal_of(mesh, other)) > kCreaseCosine)
        return;
    const Vec3 a = mesh.point(mesh.from_vertex_handle(h));
    const Vec3 b = mesh.point(mesh.to_vertex_handle(h));
    for (int i = 1; i < count; ++i)
        samples.push_back({a + i / count * (b - a), one.is_valid() ? one.idx() : other.idx()});
}

/// Leaves out needles where there are too many, and sums up what is left.
void weigh(const WorkingMesh& mesh, const EdgeTarget& target, SurfaceFaults& faults) {
    if (faults.has_too_many_needles) faults.needles.clear();
    faults.severity = 3.0 * static_cast<double>(faults.crossings.size());
    for (const int f : faults.needles) {
        const auto [a, b, c] = points_of(mesh, f);
        faults.severity += 0.5 + 7 * (kSmallAngle - std::acos(cosine_of_smallest_angle(a, b, c)));
    }
    if (!faults.far.empty()) faults.severity += 6 * (faults.far[0].distance / target.length - kFar);
}

}  // namespace

Vec3 face_center(const WorkingMesh& mesh, int face) {
    const auto [a, b, c] = points_of(mesh, face);
    return (a + b + c) / 3;
}

FaultFinder::FaultFinder(const Mesh& mesh, double edge_length, bool has_fitting_features)
    : input_(mesh), edge_length_(edge_length), has_fitting_features_(has_fitting_features) {
    for (const VertexHandle v : mesh.vertices())
        if (!mesh.is_isolated(v)) samples_.push_back({mesh.point(v), mesh.cvf_iter(v)->idx()});
    for (const EdgeHandle edge : mesh.edges())
        add_crease_points(mesh, edge, 0.5 * edge_length, samples_);
}

SurfaceFaults FaultFinder::find(const WorkingMesh& mesh, const EdgeTarget& target) const {
    std::vector<int> faces(static_cast<std::size_t>(mesh.face_end()));
    std::iota(faces.begin(), faces.end(), 0);
    SurfaceFaults faults = find_among(mesh, target, faces, true);
    // So many come of features that the edge length does not suit, and no repair is the answer.
    faults.has_too_many_needles =
        !has_fitting_features_ &&
        static_cast<double>(faults.needles.size()) > kMostNeedles * mesh.face_end() + kFewNeedles;
    weigh(mesh, target, faults);
    return faults;
}

SurfaceFaults FaultFinder::find_near_sources(const WorkingMesh& mesh, const EdgeTarget& target,
                                             const SurfaceFaults& before) const {
    std::vector<bool> is_near(static_cast<std::size_t>(mesh.vertex_end()));
    for (int v = 0; v < mesh.vertex_end(); ++v)
        is_near[static_cast<std::size_t>(v)] = target.sources.is_around(mesh.point(v));
    std::vector<int> faces;
    for (int f = 0; f < mesh.face_end(); ++f) {
        const auto corners = mesh.corners(f);
        if (std::any_of(corners.begin(), corners.end(),
                        [&](int v) { return is_near[static_cast<std::size_t>(v)]; }))
            faces.push_back(f);
    }
    SurfaceFaults faults = find_among(mesh, target, faces, false);
    faults.has_too_many_needles = before.has_too_many_needles;
    weigh(mesh, target, faults);
    return faults;
}

SurfaceFaults FaultFinder::find_among(const WorkingMesh& mesh, const EdgeTarget& target,
                                      const std::vector<int>& faces, bool is_everywhere) const {
    SurfaceFaults faults;
    if (faces.empty()) return faults;
    find_crossings(mesh, faces, faults);
    for (const int f : faces) {
        const auto [a, b, c] = points_of(mesh, f);
        if (cosine_of_smallest_angle(a, b, c) > std::cos(kSmallAngle) && !is_angle_forced(mesh, f))
            faults.needles.push_back(f);
    }
    find_far(mesh, target, faces, is_everywhere, faults);
    return faults;
}

void FaultFinder::find_crossings(const WorkingMesh& mesh, const std::vector<int>& faces,
                                 SurfaceFaults& faults) const {
    std::vector<Vec3> points;
    for (int v = 0; v < mesh.vertex_end(); ++v) points.push_back(mesh.point(v));
    std::vector<std::array<int, 3>> triangles;
    for (const int f : faces) triangles.push_back(mesh.corners(f));
    const auto pairs = self_intersections(points, triangles);
    if (pairs.empty()) return;
    if (!is_input_known_) {
        for (const auto& pair : self_intersections(input_))
            for (const int f : pair) {
                const auto v = face_vertices(input_, FaceHandle(f));
                input_crossings_.push_back(
                    (input_.point(v[0]) + input_.point(v[1]) + input_.point(v[2])) / 3);
            }
        is_input_known_ = true;
    }
    const auto is_known = [&](const Vec3& p) {
        return std::any_of(input_crossings_.begin(), input_crossings_.end(), [&](const Vec3& q) {
            return (p - q).squaredNorm() < edge_length_ * edge_length_;
        });
    };
    for (const auto& [i, j] : pairs) {
        const int one = faces[static_cast<std::size_t>(i)];
        const int other = faces[static_cast<std::size_t>(j)];
        if (!is_known(face_center(mesh, one)) && !is_known(face_center(mesh, other)))
            faults.crossings.push_back({one, other});
    }
}

void FaultFinder::find_far(const WorkingMesh& mesh, const EdgeTarget& target,
                           const std::vector<int>& faces, bool is_everywhere,
                           SurfaceFaults& faults) const {
    std::vector<std::array<Vec3, 3>> corners;
    for (const int f : faces) corners.push_back(points_of(mesh, f));
    const ReferenceSurface surface(corners);
    std::vector<FarSample> far;
    int hint = -1;
    for (const SurfaceSample& sample : samples_) {
        if (!is_everywhere && target.sources.limit(sample.position) > kWellInside * target.length)
            continue;
        const ReferencePoint near =
            surface.closest(sample.position, Vec3::Zero(), kOut * target.length, hint);
        hint = near.face;
        const double distance = near.face < 0 ? kOut * target.length : near.distance;
        if (distance > kFar * target.length)
            far.push_back(
                {distance, sample, hint < 0 ? -1 : faces[static_cast<std::size_t>(hint)]});
    }
    std::stable_sort(far.begin(), far.end(), [](const FarSample& a, const FarSample& b) {
        return a.distance > b.distance;
    });
    for (const FarSample& one : far) {
        const double length = target.at(one.sample.position);
        if (std::none_of(faults.far.begin(), faults.far.end(), [&](const FarSample& other) {
                return (other.sample.position - one.sample.position).norm() < length;
            }))
            faults.far.push_back(one);
    }
}

}  // namespace fcn
