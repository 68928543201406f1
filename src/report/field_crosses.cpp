// A cross field for the eye: crosses as long as they are apart would touch, so arms are a third of
// it. Faces are taken in their order unless one that was taken is near and faces the same way, so
// that both sides of a thin wall have their own.
#include "report/field_crosses.h"

#include <array>
#include <cmath>
#include <unordered_map>

namespace fcn {
namespace {

constexpr double kArmShare = 0.34;  ///< of the spacing
constexpr double kWiden = 1.4;

using Cell = std::array<std::int64_t, 3>;
struct CellHash {
    std::size_t operator()(const Cell& c) const {
        return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
    }
};

struct Place {
    std::size_t face = 0;
    Vec3 centre, normal;
};

/// Faces that are `spacing` apart.
std::vector<Place> spread_faces(const Mesh& mesh, double spacing) {
    std::vector<Place> places;
    std::unordered_map<Cell, std::vector<std::size_t>, CellHash> cells;
    const auto is_free = [&](const Cell& own, const Place& place) {
        for (std::int64_t k = 0; k < 27; ++k) {
            const auto found =
                cells.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
            if (found == cells.end()) continue;
            for (const std::size_t i : found->second)
                if (places[i].normal.dot(place.normal) > 0 &&
                    (places[i].centre - place.centre).norm() < spacing)
                    return false;
        }
        return true;
    };
    for (const FaceHandle face : mesh.faces()) {
        Place place{static_cast<std::size_t>(face.idx()), Vec3::Zero(), face_normal(mesh, face)};
        for (const VertexHandle v : face_vertices(mesh, face)) place.centre += mesh.point(v) / 3;
        Cell own;
        for (std::size_t k = 0; k < 3; ++k)
            own[k] =
                static_cast<std::int64_t>(std::floor(place.centre[static_cast<int>(k)] / spacing));
        if (!is_free(own, place)) continue;
        cells[own].push_back(places.size());
        places.push_back(place);
    }
    return places;
}

}  // namespace

std::vector<Polyline> field_crosses(const QuadField& field, double spacing, std::size_t most) {
    std::vector<Polyline> lines;
    if (!(spacing > 0) || most == 0) return lines;
    std::vector<Place> places = spread_faces(field.mesh.mesh, spacing);
    while (places.size() > most) places = spread_faces(field.mesh.mesh, spacing *= kWiden);
    for (const Place& place : places) {
        const Vec3 along = kArmShare * spacing * field.arms[place.face];
        const Vec3 across = place.normal.cross(along);
        for (const Vec3& arm : {along, across})
            lines.push_back({place.centre - arm, place.centre + arm});
    }
    return lines;
}

}  // namespace fcn
