"""Columns and portal frame by collocation: nonlinear straight (or bent) state under P, then the zero of a tangent stiffness."""
import numpy as np, sys
from collocation import *
B1 = (0, .03, .1, .3, .7, .9, .97, 1)                    # w = 0.1
B2 = (0, .01, .03, .1, .35, .65, .9, .97, .99, 1)
C1 = (0, .004, .012, .03, .1, .5, .9, .97, .988, .996, 1)    # w = 0.01
C2 = (0, .003, .007, .013, .03, .1, .35, .65, .9, .97, .987, .993, .997, 1)
t = lambda *a: a

def held(k, e, th, slope):
    return [([(k, e, TH, 1)], th, 0), ([(k, e, LAM, 1)], 1, 0) if slope == "vector" else ([(k, e, MU, 1)], 0, 0)]

def column(kind, w, slope, n, breaks):
    """along x from the origin; returns structure, index of the row that is replaced, term that is set to one"""
    a, b = kind.split("-")
    rows = [([(0, "0", X, 1)], 0, 0), ([(0, "0", Y, 1)], 0, 0), ([(0, "F", 0, 1)], 0, -1)]
    rows += held(0, "0", 0, slope) if a == "clamped" else [([(0, "0", MO, 1)], 0, 0), ([(0, "0", MU, 1)], 0, 0)]
    if b == "free": rows += [([(0, "F", 1, 1)], 0, 0), ([(0, "1", MO, 1)], 0, 0), ([(0, "1", MU, 1)], 0, 0)]; k = (5, (0, "1", Y, 1))
    if b == "pinned": rows += [([(0, "1", Y, 1)], 0, 0), ([(0, "1", MO, 1)], 0, 0), ([(0, "1", MU, 1)], 0, 0)]; k = (6, (0, "1", TH, 1))
    if b == "clamped": rows += [([(0, "1", Y, 1)], 0, 0)] + held(0, "1", 0, slope); k = (6, (0, "1", MO, 1))
    return Structure([Member(1.0, 0.0, (0, 0), breaks, n, 12 / w**2)], rows), *k

def portal(w, slope, n, breaks, height=1.0, span=1.0):
    ms = [Member(height, np.pi / 2, (0, 0), breaks, n, 12 / w**2), Member(span, 0.0, (0, height), breaks, n, 12 / w**2),
          Member(height, np.pi / 2, (span, 0), breaks, n, 12 / w**2)]
    rows = []
    for k, x in ((0, 0.0), (2, span)): rows += [([(k, "0", X, 1)], x, 0), ([(k, "0", Y, 1)], 0, 0)] + held(k, "0", np.pi / 2, slope)
    i = len(rows)
    rows += [([(0, "F", 0, -1), (1, "F", 0, 1)], 0, 0), ([(0, "F", 1, -1), (1, "F", 1, 1)], 0, 1),
             ([(2, "F", 0, -1), (1, "F", 0, -1)], 0, 0), ([(2, "F", 1, -1), (1, "F", 1, -1)], 0, 1)]
    for k, e, sg in ((0, "0", 1), (2, "1", -1)):
        rows += [([(k, "1", c, 1), (1, e, c, -1)], 0, 0) for c in (X, Y)]
        rows += [([(k, "1", TH, 1), (1, e, TH, -1)], np.pi / 2, 0), ([(k, "1", MO, -1), (1, e, MO, sg)], 0, 0)]
        rows += [([(k, "1", LAM, 1), (1, e, LAM, -1)], 0, 0), ([(k, "1", MU, -1), (1, e, MU, sg)], 0, 0)] if slope == "vector" else \
                [([(k, "1", MU, 1)], 0, 0), ([(1, e, MU, 1)], 0, 0)]
    # the symmetric state under P: the balance of row i is replaced by the symmetry x_left + x_right = span, so that the system
    # stays regular at the bifurcation; the balance then holds by symmetry, which `critical` checks
    sway = [(0, "1", X, 1), (2, "1", X, 1)]
    state = list(rows); state[i] = (sway, span, 0)
    S = Structure(ms, state); S.full = rows
    return S, i, sway

def critical(S, i, term, P0, steps=8):
    u = S.initial.copy()
    for P in np.linspace(0, P0 * 0.98, steps)[1:]: u = S.solve(u, P)
    st = {"u": u}
    def f(P):
        st["u"] = S.solve(st["u"], P)
        rows = getattr(S, "full", S.bc)
        assert abs(S.system(st["u"], P, rows)[0]).max() < 1e-7
        return S.stiffness(st["u"], P, rows, i, term)
    P = secant(f, P0 * 0.98, P0 * 0.99, tol=1e-12)
    return P, st["u"]

if __name__ == "__main__":
    what = sys.argv[1]
    if what == "columns":
        for w, b1, b2 in ((0.1, B1, B2), (0.01, C1, C2)):
            EI = 210e9 * w**4 / 12
            for kind, beta in (("clamped-free", np.pi / 2), ("pinned-pinned", np.pi), ("clamped-clamped", 2 * np.pi)):
                p = beta**2 * w**2 / 12
                Pc = beta**2 * np.sqrt(1 - 2 * p)
                for slope in ("direction", "vector"):
                    if kind == "pinned-pinned" and slope == "vector": continue
                    a, b = (critical(*column(kind, w, slope, n, br), Pc)[0] * EI for n, br in ((12, b1), (16, b2)))
                    print(f"w {w} {kind:16s} {slope:10s} P_c {a:.10f} {b:.10f} rel {abs(a/b-1):.1e}  against the closed form of direction {b/EI/Pc-1:.10e}", flush=True)
    else:
        w, EI = 0.01, 175.0
        for slope in ("direction", "vector"):
            r = []
            for n, br in ((12, C1), (16, C2)):
                S, i, term = portal(w, slope, n, br)
                P, u = critical(S, i, term, 7.37)
                r.append(P * EI)
                m = S.members[0]; z = u[:m.size - 2].reshape(-1, 6); print("   corner", z[-1], "H in the beam", u[S.off[2] - 2] * EI)
            print(f"portal {slope:10s} P_c {r[0]:.11f} {r[1]:.11f} rel {abs(r[0]/r[1]-1):.1e}", flush=True)
