// The vectors of IDA, seen as vectors of Eigen.
#pragma once

#include "run.hpp"

inline double *data(const ida::Vector &v) { return N_VGetArrayPointer(v.get()); }
inline Eigen::Map<const VectorXd> part(const double *y, int offset, int size) { return {y + offset, size}; }
inline Eigen::Map<VectorXd> part(double *y, int offset, int size) { return {y + offset, size}; }
