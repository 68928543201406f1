#pragma once

#include "meshing/matched_field.h"

namespace fcn {

struct Singularity {
    int vertex = -1;
    int index = 0;  ///< quarters: 1 has three quads around it, -1 five
};

/// Vertices of index other than 0 inside the mesh, ascending.
std::vector<Singularity> inner_singularities(const Mesh& mesh, const std::vector<int>& indices);

struct MergingOptions {
    double distance = 0;        ///< up to which pairs are cancelled, along edges, mesh units
    double kept_distance = 0;   ///< the same for pairs of kept vertices; at most `distance`
    std::vector<bool> is_kept;  ///< per vertex; empty: none
};

/// Cancels pairs of opposite singularities that are close, nearest first, by changing turns along
/// the path between them; the angles are left to straighten(). Returns the number of pairs.
/// Deterministic.
int merge_singularities(const Mesh& mesh, const FaceConnection& connection,
                        const MergingOptions& options, MatchedField& matched);

/// Takes indices of two quarters and more apart: all but one quarter go to vertices up to
/// `distance` away, far from each other. Returns the number of quarters moved. Deterministic.
int separate_quarters(const Mesh& mesh, const FaceConnection& connection, double distance,
                      MatchedField& matched);

/// Pairs of opposite singularities closer than `distance` along edges.
int close_pairs(const Mesh& mesh, const std::vector<Singularity>& singularities, double distance);

}  // namespace fcn
