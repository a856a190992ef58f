// How errors call an item of the description.
#pragma once

#include <string>

inline std::string named(const char *what, int index) { return std::string(what) + " " + std::to_string(index); }
