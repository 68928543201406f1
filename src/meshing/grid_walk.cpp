// Lines of the grid over a surface. They are parallel to an axis in every chart, so which side of
// one a corner lies on is a comparison of whole numbers, and the way out of each face is certain:
// across an edge whose ends lie on either side, or through a vertex, around which the next face is
// looked for (Ebke, Bommes, Campen, Kobbelt 2013, section 4.2).
#include "meshing/grid_walk.h"

namespace fcn {

/// A way in the chart of a face that it crosses.
struct GridWalk::Step {
    int face = -1;
    int direction = 0;
    GridPoint start, goal;
};

std::optional<GridPlace> GridWalk::go(const GridPlace& from, std::int64_t distance) const {
    const GridPoint way = direction_vector(from.direction);
    Step step{from.face, from.direction, from.image,
              from.image + GridPoint{way.u * distance, way.v * distance}};
    // Without folds a straight line of length 1 is in no face twice, apart from its charts.
    for (int i = 0; i <= 4 * map_.face_count(); ++i) {
        if (is_at_goal(step)) return GridPlace{step.face, step.goal, step.direction};
        if (!leave_face(step)) return {};
    }
    return {};
}

bool GridWalk::is_at_goal(const Step& step) const {
    const int h = 3 * step.face;
    return map_.side(h, step.goal) >= 0 && map_.side(h + 1, step.goal) >= 0 &&
           map_.side(h + 2, step.goal) >= 0;
}

void GridWalk::cross(Step& step, int h) const {
    const GridTransition& transition = map_.across(h);
    step = {GridMap::face(map_.twin(h)), (step.direction + transition.quarters) & 3,
            transition(step.start), transition(step.goal)};
}

bool GridWalk::leave_face(Step& step) const {
    const GridPoint way = direction_vector(step.direction);
    std::int64_t sides[3];
    for (int i = 0; i < 3; ++i) {
        const GridPoint p = map_.image(3 * step.face + i) - step.start;
        sides[i] = way.u * p.v - way.v * p.u;
    }
    int exit = -1;
    std::int64_t farthest = 0;
    for (int i = 0; i < 3; ++i) {
        const int h = 3 * step.face + i;
        if (sides[i] < 0 && sides[(i + 1) % 3] > 0) {
            if (map_.twin(h) < 0) return false;
            cross(step, h);
            return true;
        }
        const GridPoint p = map_.image(h) - step.start;
        const std::int64_t along = way.u * p.u + way.v * p.v;
        if (sides[i] == 0 && (exit < 0 || along > farthest)) {
            exit = h;
            farthest = along;
        }
    }
    return exit >= 0 && pass_vertex(step, exit);
}

/// Goes on from the origin of h, a corner of the step's face.
bool GridWalk::pass_vertex(Step& step, int h) const {
    const Step before = step;
    const int first = h;
    do {
        if (map_.is_in_corner(h, step.direction)) return true;
        const int end = GridMap::prev(h);
        if (map_.twin(end) < 0) {
            if (map_.is_on_corner_end(h, step.direction)) return true;
            break;
        }
        cross(step, end);
        h = map_.twin(end);
    } while (h != first);
    step = before;
    for (h = first; map_.twin(h) >= 0;) {
        cross(step, h);
        h = GridMap::next(map_.twin(h));
        if (h == first) return false;
        if (map_.is_in_corner(h, step.direction)) return true;
    }
    return false;
}

}  // namespace fcn
