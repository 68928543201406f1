#pragma once

#include <vector>

#include "adaptation/conformity_surface.h"

namespace fcn::conformity {

/// Exact surface distances (polyhedral geodesics) between nearby points. Keeps scratch memory the
/// size of the mesh, so one object serves many queries, one at a time.
class Geodesics {
public:
    explicit Geodesics(const Surface& surface);

    /// Surface distance if below `limit`, else infinity. Exact up to rounding (about 1e-9
    /// relative). Only faces that meet the ellipsoid |x - from| + |x - to| < limit are visited.
    double distance(const Foot& from, const Foot& to, double limit);

private:
    /// Straight paths through an edge, unfolded into the plane of the face they enter: x along
    /// the half-edge from its origin, y into its face.
    struct Window {
        int halfedge = -1;
        double first = 0, last = 0;         ///< interval of x
        double source_x = 0, source_y = 0;  ///< image of the (pseudo) source, source_y <= 0
        double offset = 0;                  ///< distance of the source itself
    };
    struct Event {
        double key = 0;     ///< lower bound of any path to the target through this
        long sequence = 0;  ///< breaks ties
        int window = -1;    ///< index into windows_, or
        int vertex = -1;    ///< a pseudo source
        double distance = 0;
        bool operator<(const Event& other) const {
            return key != other.key ? key > other.key : sequence > other.sequence;
        }
    };
    struct CornerRecord {
        double distance = 0, crossing = 0;
        long query = 0;
    };

    void start(const Foot& from);
    void add_face_source(const Vec3& source, int face, int skipped_halfedge, double offset);
    void add_window(const Window& window);
    void reach_vertex(int vertex, double distance);
    void reach_target(const Window& window);
    void expand_vertex(int vertex);
    void propagate(const Window& window);
    void pass_on(const Window& parent, int halfedge, double origin_x, double origin_y,
                 double target_x, double target_y, double first_x, double last_x);
    bool is_useless(const Window& window) const;
    double vertex_distance(int vertex) const;
    double length(int halfedge) const;
    Eigen::Vector2d flatten(int halfedge, const Vec3& point) const;

    const Surface& surface_;
    const FlatMesh& mesh_;
    std::vector<bool> is_bending_;  ///< per vertex: shortest paths may pass through it
    std::vector<double> distances_;
    std::vector<long> distance_query_;
    std::vector<CornerRecord> corner_records_;  ///< per half-edge, for its opposite corner
    std::vector<Window> windows_;
    std::vector<Event> queue_;
    long query_ = 0, sequence_ = 0;
    Foot target_;
    std::vector<int> target_faces_;
    double best_ = 0;
};

}  // namespace fcn::conformity
