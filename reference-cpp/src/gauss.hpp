// Gauss-Legendre rules on [0, 1].
#pragma once

#include <array>

struct GaussPoint {
    double x, weight;
};

// exact to degree 3
inline constexpr std::array<GaussPoint, 2> gauss2{{{0.21132486540518711775, 0.5}, {0.78867513459481288225, 0.5}}};

// exact to degree 5
inline constexpr std::array<GaussPoint, 3> gauss3{{{0.11270166537925831148, 0.27777777777777777778},
                                                   {0.5, 0.44444444444444444444},
                                                   {0.88729833462074168852, 0.27777777777777777778}}};

// exact to degree 9: the axial energy of a cubic element has degree 8 (eq. 11), its mass matrix degree 6 (eq. 10)
inline constexpr std::array<GaussPoint, 5> gauss5{{{0.04691007703066800360, 0.11846344252809454376},
                                                   {0.23076534494715845448, 0.23931433524968323402},
                                                   {0.5, 0.28444444444444444444},
                                                   {0.76923465505284154552, 0.23931433524968323402},
                                                   {0.95308992296933199640, 0.11846344252809454376}}};
