// What is reported of a state: gaps, energies, powers, reactions.
#include <algorithm>

#include "damping.hpp"
#include "system.hpp"

void Powers::add(double weight, const Powers &p) {
    work += weight * p.work;
    contact_dissipated += weight * p.contact_dissipated;
    clamp += weight * p.clamp;
    friction_dissipated += weight * p.friction_dissipated;
    normal_variation += weight * p.normal_variation;
    damping_dissipated += weight * p.damping_dissipated;
}

Gap System::gap(int k, const double *q, const double *v) const {
    const Joint &j = joints_[k];
    const double *qi = q + j.bearing.offset, *qj = q + j.journal.offset;
    const double *vi = v + j.bearing.offset, *vj = v + j.journal.offset;
    if (j.kind == JointKind::prismatic) { // the part of the eccentricity across the guide, s m
        const GuideMotion<double> x = guide_motion(j.direction, j.bearing, j.journal, qi, vi, qj, vj);
        return {x.s * x.m, x.s_rate * x.m - (x.s * x.spin) * x.u, law(k).clearance};
    }
    return {position(j.journal, qj) - position(j.bearing, qi),
            velocity(j.journal, qj, vj) - velocity(j.bearing, qi, vi), law(k).clearance};
}

LooseForces<double> System::loose(int k, const VectorXd &q, const VectorXd &v, const Memory &memory) const {
    const Joint &j = joints_[k];
    const double *qi = q.data() + j.bearing.offset, *qj = q.data() + j.journal.offset;
    const double *vi = v.data() + j.bearing.offset, *vj = v.data() + j.journal.offset;
    return contact_forces(j, memory.impact_velocity[k], bristle(k, memory), qi, vi, qj, vj);
}

double System::bristle(int k, const Memory &memory) const {
    const int state = joints_[k].bristle;
    return state < 0 ? 0.0 : memory.state[state];
}

double System::bristle_energy(int k, const VectorXd &q, const VectorXd &v, const Memory &memory) const {
    return loose(k, q, v, memory).normal * law(k).friction.stored(bristle(k, memory));
}

double System::bristle_energy(const VectorXd &q, const VectorXd &v, const Memory &memory) const {
    double sum = 0.0;
    for (int k : loose_)
        if (joints_[k].bristle >= 0) sum += bristle_energy(k, q, v, memory);
    return sum;
}

Energies System::energies(const VectorXd &q, const VectorXd &v, const Memory &memory) const {
    Energies sum;
    sum.kinetic = 0.5 * v.dot(mass_ * v);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const ElasticEnergy u = element_energy(b.element, q.data() + b.offset + 4 * e);
            sum.axial += u.axial;
            sum.bending += u.bending;
        }
    for (int k : loose_) {
        const LooseForces<double> l = loose(k, q, v, memory);
        sum.contact += l.elastic_normal * l.delta / (law(k).exponent + 1.0);
        sum.contact += l.normal * law(k).friction.stored(bristle(k, memory));
    }
    sum.gravity = -weight_.dot(q);
    for (const Spring &s : springs_) sum.springs += energy(s, q);
    for (std::size_t i = 0; i < torsion_springs_.size(); ++i)
        sum.springs += energy(torsion_springs_[i], memory.turn[static_cast<int>(i)], q);
    for (std::size_t i = 0; i < maxwells_.size(); ++i)
        sum.springs += energy(maxwells_[i], memory.state[elongation(static_cast<int>(i))], q);
    return sum;
}

Powers System::powers(const Inputs &inputs, const VectorXd &q, const VectorXd &v, const Memory &memory) const {
    Powers p;
    for (const Load &l : loads_) {
        const Vec<double> applied{inputs.given[l.x].value, inputs.given[l.y].value};
        const PairForces<double> forces =
            load_forces(l, applied, q.data() + l.reaction.offset, q.data() + l.point.offset);
        p.work += power(l.reaction, l.point, forces, v);
    }
    for (int k : loose_) {
        if (memory.impact_velocity[k] <= 0.0) continue;
        const LooseForces<double> l = loose(k, q, v, memory);
        const double lost = (l.normal - l.elastic_normal) * l.rate;
        p.contact_dissipated += lost;
        if (l.clamped) p.clamp += lost;
        const double stored = l.normal * law(k).friction.s0 * bristle(k, memory) * l.state_rate; // in the bristles
        p.friction_dissipated -= l.friction_power + stored;
        p.normal_variation -= stored;
    }
    for (const Spring &s : springs_) p.damping_dissipated += loss(s, q, v);
    for (const TorsionSpring &s : torsion_springs_) p.damping_dissipated += loss(s, q, v);
    for (std::size_t i = 0; i < maxwells_.size(); ++i)
        p.damping_dissipated += loss(maxwells_[i], memory.state[elongation(static_cast<int>(i))], q);
    for (const Body &b : bodies_) {
        if (b.strain_damping == 0.0) continue;
        for (int e = 0; e < b.elements; ++e) {
            const int o = b.offset + 4 * e;
            p.damping_dissipated += damping_power(b.element, b.strain_damping, q.data() + o, v.data() + o);
        }
    }
    p.damping_dissipated += v.dot(mass_damping_ * v);
    return p;
}

bool System::prescribes_motion() const {
    return std::any_of(constraints_.begin(), constraints_.end(), [](const Constraint &c) { return c.timed(); });
}

bool System::has_power() const {
    if (prescribes_motion() || !loads_.empty() || !maxwells_.empty() || mass_damping_.nonZeros() > 0) return true;
    for (const Spring &s : springs_)
        if (s.damping > 0.0) return true;
    for (const TorsionSpring &s : torsion_springs_)
        if (s.damping > 0.0) return true;
    for (const Body &b : bodies_)
        if (b.strain_damping > 0.0) return true;
    return false;
}

// -Phi_q^T lambda on the coordinates of the journal, as a force on its point.
Vec<double> System::joint_force(int k, const VectorXd &q, const VectorXd &v, const Memory &memory,
                                const VectorXd &lambda) const {
    const Joint &j = joints_[k];
    if (j.law) return loose(k, q, v, memory).on_journal;
    auto multiplier = [&](int row) { return row < 0 ? 0.0 : lambda[row]; };
    if (j.kind == JointKind::revolute || j.kind == JointKind::weld)
        return {multiplier(j.rows[0]), multiplier(j.rows[1])};
    if (j.rows[0] < 0) return {0.0, 0.0};
    return -lambda[j.rows[0]] * by_journal(constraints_[j.rows[0]], q);
}

double System::joint_couple(int k, const Inputs &inputs, const VectorXd &q, const VectorXd &lambda) const {
    const Joint &j = joints_[k];
    double couple = 0.0;
    for (int row : {j.holds[0], j.holds[1], j.drive})
        if (row >= 0)
            couple -= lambda[row] * by_rotation(constraints_[row], q, prescription(constraints_[row], inputs).value);
    return couple;
}
