// What is reported of a state: gaps, energies, powers, reactions.
#include "damping.hpp"
#include "system.hpp"

Gap System::gap(int k, const double *q, const double *v) const {
    const Joint &j = joints_[k];
    const double *qi = q + j.bearing.offset, *qj = q + j.journal.offset;
    const double *vi = v + j.bearing.offset, *vj = v + j.journal.offset;
    return {position(j.journal, qj) - position(j.bearing, qi),
            velocity(j.journal, qj, vj) - velocity(j.bearing, qi, vi), law(k).clearance};
}

LooseForces<double> System::loose(int k, const VectorXd &q, const VectorXd &v, double z) const {
    const Joint &j = joints_[k];
    return loose_forces<double>(law(k), z, j.bearing, j.journal, q.data() + j.bearing.offset,
                                v.data() + j.bearing.offset, q.data() + j.journal.offset, v.data() + j.journal.offset);
}

Energies System::energies(const VectorXd &q, const VectorXd &v, const VectorXd &z) const {
    Energies sum;
    sum.kinetic = 0.5 * v.dot(sparse_mass_ * v);
    for (const Body &b : bodies_)
        for (int e = 0; e < b.elements; ++e) {
            const ElasticEnergy u = element_energy(b.element, q.data() + b.offset + 4 * e);
            sum.axial += u.axial;
            sum.bending += u.bending;
        }
    for (int k : loose_) {
        const LooseForces<double> l = loose(k, q, v, z[k]);
        sum.contact += l.elastic_normal * l.delta / (law(k).exponent + 1.0);
    }
    sum.gravity = -weight_.dot(q);
    for (const Spring &s : springs_) sum.springs += energy(s, q);
    for (const TorsionSpring &s : torsion_springs_) sum.springs += energy(s, q);
    return sum;
}

Powers System::powers(const std::vector<Prescribed> &functions, const VectorXd &q, const VectorXd &v,
                      const VectorXd &z) const {
    Powers p;
    for (const Load &l : loads_) {
        const Vec<double> applied{functions[l.x].value, functions[l.y].value};
        const PairForces<double> forces =
            load_forces(l, applied, q.data() + l.reaction.offset, q.data() + l.point.offset);
        p.work += power(l.reaction, l.point, forces, v);
    }
    for (int k : loose_) {
        if (z[k] <= 0.0) continue;
        const LooseForces<double> l = loose(k, q, v, z[k]);
        const double lost = (l.normal - l.elastic_normal) * l.rate;
        p.contact_dissipated += lost;
        if (l.clamped) p.clamp += lost;
        p.friction_dissipated -= l.friction_power;
    }
    for (const Spring &s : springs_) p.damping_dissipated += loss(s, q, v);
    for (const TorsionSpring &s : torsion_springs_) p.damping_dissipated += loss(s, q, v);
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

bool System::prescribes_motion() const { return !legs_.empty() || !motions_.empty() || !prescribed_.empty(); }

bool System::has_power() const {
    if (prescribes_motion() || !loads_.empty() || mass_damping_.nonZeros() > 0) return true;
    for (const Spring &s : springs_)
        if (s.damping > 0.0) return true;
    for (const TorsionSpring &s : torsion_springs_)
        if (s.damping > 0.0) return true;
    for (const Body &b : bodies_)
        if (b.strain_damping > 0.0) return true;
    return false;
}

// -Phi_q^T lambda on the coordinates of the journal, as a force on its point.
Vec<double> System::joint_force(int k, const VectorXd &q, const VectorXd &v, const VectorXd &z,
                                const VectorXd &lambda) const {
    const Joint &j = joints_[k];
    if (j.contact >= 0) return loose(k, q, v, z[k]).on_journal;
    if (j.kind == LS_PRISMATIC) return -lambda[j.constraint] * by_journal(constraints_[j.constraint], q);
    return {lambda[j.constraint], lambda[j.constraint + 1]};
}

double System::joint_couple(int k, const VectorXd &q, const VectorXd &lambda) const {
    const Joint &j = joints_[k];
    double couple = 0.0;
    for (int row = j.holding; row < j.holding + j.held; ++row) couple -= lambda[row] * by_rotation(constraints_[row], q, 0.0);
    return couple;
}

double System::motion_force(int motion, const Inputs &inputs, const VectorXd &q, const VectorXd &lambda) const {
    const int row = motions_[motion];
    const Constraint &c = constraints_[row];
    return c.kind == Constraint::align ? -lambda[row] * by_rotation(c, q, given(c, inputs)) : -lambda[row];
}
