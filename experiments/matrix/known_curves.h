#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"
#include "network/network.h"

namespace fcn {

/// A mesh whose feature curves are known: the clean shape, and the mesh edges on its curves.
struct KnownPart {
    std::string name;
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<int, 2>> curve_edges;  ///< vertices of edges on curves of the shape

    double mean_edge() const;
};

/// A built-in model of about `face_count` faces. Its curves are the edges of 40 degrees and more,
/// and of 18 and more that have no comparable edge beside them: the models consist of flat and
/// smooth pieces whose curves the mesh follows. The superellipse torus has its crests for curves
/// instead, which no mesh edges follow: see crest_circles().
KnownPart model_part(const std::string& name, int face_count);

/// A mesh with the curves of NAME.cadedges.txt beside it (lines of two vertices and a tag); without
/// such a file they are marked as in a model. Throws InputError if the file does not fit the mesh.
KnownPart cad_part(const std::filesystem::path& mesh_file);

/// One step of Loop subdivision, curves by the rules for creases: four times the faces of a smooth
/// shape through the same curves.
KnownPart refined(const KnownPart& part);

/// The mesh with each coordinate of each vertex displaced by a normal number of standard deviation
/// `noise` mean edges.
LoadedMesh noisy_mesh(const KnownPart& part, double noise, std::uint64_t seed);

/// What a detector should find: `required` curves (40 degrees and more) and all `allowed` ones.
struct KnownCurves {
    FeatureCurveNetwork required, allowed;
};

KnownCurves known_curves(const KnownPart& part);

/// The four crest circles of the model superellipse-torus.
KnownCurves crest_circles();

struct CurveScore {
    std::size_t curve_count = 0;
    double length = 0;
    double precision = 1;  ///< share of the length within the tolerance of an allowed curve
    double recall = 1;     ///< share of the required length within the tolerance of a found one
};

CurveScore score(const FeatureCurveNetwork& found, const KnownCurves& known, double tolerance);

/// Share of the length of `network` within `tolerance` of `other`; 1 if it has no length.
double share_near(const FeatureCurveNetwork& network, const FeatureCurveNetwork& other,
                  double tolerance);

}  // namespace fcn
