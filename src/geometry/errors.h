#pragma once

#include <stdexcept>
#include <string>

namespace fcn {

/// Bad input from outside: the message names the file, the line where known, and the value.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A broken invariant of ours.
class LogicError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

}  // namespace fcn
