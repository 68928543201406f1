#pragma once

#include <cstdint>
#include <string>

#include "experiment/bootstrap.h"

namespace experiment {

/// Numbers as people read them; a dash for NaN.
std::string seconds_text(double seconds);             ///< three digits; "0.123", "12.3", "1230"
std::string percent_text(double share);               ///< of a share: "0.12%"
std::string ratio_text(double ratio);                 ///< "1.23"
std::string decimal_text(double number, int digits);  ///< so many after the point
std::string count_text(double number);                ///< "12,345"
std::string number_text(double number);               ///< four digits: "323.5", "0.012"
/// "0.52% [0.31, 0.80]"; without the brackets when the interval is not known.
std::string percent_interval(const Interval& interval);
std::string seconds_interval(const Interval& interval);
std::string ratio_interval(const Interval& interval);

}  // namespace experiment
