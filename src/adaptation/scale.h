#pragma once

namespace fcn {

enum class ElementType { Triangle, Quad };

/// The scale interval S = [rmin, rmax] and what follows from it (paper section 4.1; DESIGN for
/// the corrected bounds). Angles in radians, lengths in mesh units.
struct ScaleInterval {
    double rmin = 0;
    double rmax = 0;
    double height = 0;  ///< h = sqrt(rmin^2 - rmax^2 / 4): the flattest triangle's height
    double alpha_min = 0;
    double alpha_max = 0;
    int multiples = 3;              ///< k = 1 .. multiples
    double triangle_alpha_min = 0;  ///< of the triangle criterion, whatever the target
    ElementType target = ElementType::Triangle;

    double ratio() const { return rmax / rmin; }
    bool contains(double length) const;          ///< in [rmin, rmax], relative tolerance 1e-6
    bool is_feasible_angle(double angle) const;  ///< in the union of [k a_min, k a_max], tol. 1e-6
};

/// Relative tolerance of every conformity test.
inline constexpr double kScaleTolerance = 1e-6;
/// Longest segment allowed (once an arc), in rmin.
inline constexpr double kLongSegmentFactor = 2.06;

/// Throws InputError unless rmin > 0 and ratio in [1.01, sqrt(3)).
ScaleInterval make_scale(double rmin, double ratio = 1.5,
                         ElementType target = ElementType::Triangle);

}  // namespace fcn
