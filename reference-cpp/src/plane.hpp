// Vectors of the plane over any scalar.
#pragma once

#include <cmath>

template <class T>
struct Vec {
    T x{}, y{};
};

template <class T>
Vec<T> operator+(const Vec<T> &a, const Vec<T> &b) { return {a.x + b.x, a.y + b.y}; }
template <class T>
Vec<T> operator-(const Vec<T> &a, const Vec<T> &b) { return {a.x - b.x, a.y - b.y}; }
template <class T>
Vec<T> operator-(const Vec<T> &a) { return {-a.x, -a.y}; }
template <class T>
Vec<T> operator*(const T &s, const Vec<T> &a) { return {s * a.x, s * a.y}; }

template <class T>
T dot(const Vec<T> &a, const Vec<T> &b) { return a.x * b.x + a.y * b.y; }
template <class T>
T cross(const Vec<T> &a, const Vec<T> &b) { return a.x * b.y - a.y * b.x; }
// a turned by +90 degrees
template <class T>
Vec<T> turned(const Vec<T> &a) { return {-a.y, a.x}; }
// a turned counterclockwise by an angle
template <class T>
Vec<T> rotated(const Vec<T> &a, const T &angle) {
    using std::cos;
    using std::sin;
    const T c = cos(angle), s = sin(angle);
    return {c * a.x - s * a.y, s * a.x + c * a.y};
}
