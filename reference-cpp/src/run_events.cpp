// Onset and loss of contact.
#include <algorithm>
#include <cmath>
#include <limits>

#include "run_vectors.hpp"

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

} // namespace

// Decides at the end of the interval which contacts close or open; may shorten the interval.
void Run::find_events(const int *flagged) {
    const std::vector<int> &loose = system_.loose_joints();
    double earliest = t_;
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const double event = crossing(loose[i], watch_before_[i], flagged[i] != 0);
        if (event < earliest) {
            earliest = event;
            pending_.clear();
        }
        if (event <= earliest) pending_.push_back(loose[i]);
    }
    if (earliest < t_) {
        check(IDAGetDky(ida_, earliest, 0, y_.get()));
        t_ = earliest;
    }
    restart_pending_ = !pending_.empty();
}

// The first instant in the last interval at which f = s gap rises through zero, s = 1 for an open contact, -1 for a
// closed one; never if there is none. IDA compares the signs of f at the two ends of a step. That is not all: f can
// rise above zero and fall again inside one step, so its maximum is looked at; and where the interval starts with a
// restart f is zero up to rounding, and its sign there says nothing.
double Run::crossing(int joint, const Watch &then, bool flagged) {
    const double s = closed(joint) ? -1.0 : 1.0;
    const Watch now = watch(joint, data(y_));
    auto f = [s](const Watch &w) { return s * w.gap; };
    auto rate = [s](const Watch &w) { return s * w.rate; };
    const bool has_maximum = rate(then) > 0.0 && rate(now) < 0.0;
    const double reach = f(then) + 2.0 * rate(then) * (t_ - before_); // twice what the first slope could bring it up
    if (has_maximum && f(then) < 0.0 && reach > 0.0) {
        const double top = bisect(before_, t_, [&](const Watch &w) { return -rate(w); }, joint);
        if (f(interpolated(joint, top)) > 0.0) return bisect(before_, top, f, joint);
    }
    if (flagged) return t_;
    if (!(f(now) > 0.0)) return never;
    if (f(then) < 0.0) return bisect(before_, t_, f, joint);
    if (rate(then) < 0.0) { // f fell from zero first
        const double bottom = bisect(before_, t_, rate, joint);
        if (rate(now) > 0.0) return f(interpolated(joint, bottom)) < 0.0 ? bisect(bottom, t_, f, joint) : bottom;
        return never; // on its way back over zero
    }
    return before_; // it grew from zero
}

Run::Watch Run::interpolated(int joint, double t) {
    check(IDAGetDky(ida_, t, 0, scratch_.get()));
    return watch(joint, data(scratch_));
}

// The zero of f between f(from) < 0 and f(to) > 0, to the last bit of t.
template <class Function>
double Run::bisect(double from, double to, Function f, int joint) {
    for (;;) {
        const double middle = 0.5 * (from + to);
        if (!(middle > from && middle < to)) return to;
        (f(interpolated(joint, middle)) > 0.0 ? to : from) = middle;
    }
}

bool Run::bristles_touch() const {
    const std::vector<int> &loose = system_.loose_joints();
    return std::any_of(loose.begin(), loose.end(), [&](int k) { return closed(k) && system_.joints()[k].bristle >= 0; });
}

void Run::watch_clamps() {
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const bool now = closed(loose[i]) && system_.loose(loose[i], q_, v_, memory_).clamped;
        if (now && !clamped_[i]) ++statistics_.clamps;
        clamped_[i] = now;
    }
}

// The penetration of a closed contact is largest at an end of an interval or where its rate falls through zero inside.
void Run::watch_depth() {
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const int k = loose[i];
        if (!closed(k)) continue;
        deepest_[i] = std::max(deepest_[i], system_.gap(k, q_.data(), v_.data()).delta());
        if (!(watch_before_[i].rate > 0.0 && system_.gap(k, q_.data(), v_.data()).rate() < 0.0)) continue;
        const double top = bisect(before_, t_, [](const Watch &w) { return -w.rate; }, k);
        interpolated(k, top);
        deepest_[i] = std::max(deepest_[i], system_.gap(k, data(scratch_), data(scratch_) + n_).delta());
    }
}

void Run::apply_pending_events() {
    const std::vector<int> &loose = system_.loose_joints();
    for (int k : pending_) {
        const auto i = std::find(loose.begin(), loose.end(), k) - loose.begin();
        const Gap g = system_.gap(k, q_.data(), v_.data());
        const double speed = g.rate();
        const bool onset = !closed(k);
        events_.push_back({t_, speed, g.e.x, g.e.y, onset ? 0.0 : deepest_[i], k, onset ? 1 : 0});
        if (const int bristle = system_.joints()[k].bristle; bristle >= 0) { // they are straight where contact begins
            if (!onset) ledger_.friction_dissipated += system_.bristle_energy(k, q_, v_, memory_);
            memory_.state[bristle] = 0.0;
        }
        memory_.impact_velocity[k] = onset ? std::max(speed, system_.law(k).impact_velocity_floor) : 0.0;
        clamped_[i] = 0;
        deepest_[i] = 0.0;
    }
    pending_.clear();
}

// Where closed contacts start or cease to be clamped, in the last interval up to `to`.
std::vector<double> Run::kinks(double to) {
    std::vector<double> times;
    const std::vector<int> &loose = system_.loose_joints();
    for (std::size_t i = 0; i < loose.size(); ++i) {
        const int k = loose[i];
        if (!closed(k)) continue;
        auto pull = [&](const Watch &w) { return -bracket(system_.law(k), w.rate, memory_.impact_velocity[k]); };
        const double first = pull(watch_before_[i]), last = pull(to == t_ ? watch(k, data(y_)) : interpolated(k, to));
        if (first * last >= 0.0) continue;
        const double sign = first < 0.0 ? 1.0 : -1.0;
        times.push_back(bisect(before_, to, [&](const Watch &w) { return sign * pull(w); }, k));
    }
    std::sort(times.begin(), times.end());
    return times;
}
