// The one exception of the library. interface.cpp turns it into an ls_error; it never leaves the library.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

#include "reference.h"

// A place in a scene: the path of a field and where it stands. The line of a value that does not come from the file is 0.
struct Source {
    std::string field;
    int line = 0, column = 0;
};

struct Failure : std::runtime_error {
    Failure(ls_code c, const std::string &message, double t = 0.0, int f = 0)
        : std::runtime_error(message), code(c), time(t), flag(f) {}
    ls_code code;
    double time;
    int flag;
    Source source; // empty: the failure has no place in the scene
};

// A number in a message.
inline std::string text_of(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", x);
    return buffer;
}

[[noreturn]] inline void refuse(const Source &source, const std::string &message) {
    Failure failure(LS_BAD_INPUT, message);
    failure.source = source;
    throw failure;
}

inline void require(bool condition, const Source &source, const std::string &message) {
    if (!condition) refuse(source, message);
}

inline void require(bool condition, const std::string &message) {
    if (!condition) throw Failure(LS_BAD_INPUT, message);
}
