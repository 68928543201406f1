#pragma once

#include <stdexcept>
#include <string>

namespace labeling {

/// Bad input from outside: names the file (or stream), the line where known, and the value.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A broken invariant of this library: a fault of ours, never the user's.
class LogicError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

}  // namespace labeling
