// Vectors of the plane over any scalar.
#pragma once

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
