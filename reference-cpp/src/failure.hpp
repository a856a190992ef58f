// The one exception of the library. interface.cpp turns it into an ls_error; it never leaves the library.
#pragma once

#include <stdexcept>
#include <string>

#include "reference.h"

struct Failure : std::runtime_error {
    Failure(ls_code c, const std::string &message, double t = 0.0, int f = 0)
        : std::runtime_error(message), code(c), time(t), flag(f) {}
    ls_code code;
    double time;
    int flag;
};

inline void require(bool condition, const std::string &message) {
    if (!condition) throw Failure(LS_BAD_INPUT, message);
}
