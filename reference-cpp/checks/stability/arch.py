"""Limit points and symmetry-breaking bifurcations of the arch of two straight links; collocation, two meshes."""
import numpy as np, sys
from collocation import *
from arch_scan import half
w, EI = 0.01, 175.0
B1 = (0, .004, .012, .03, .08, .2, .5, .8, .92, .97, .988, .996, 1)
B2 = (0, .003, .007, .013, .03, .1, .35, .65, .9, .97, .987, .993, .997, 1)

def run(h, slope, n, breaks, guesses):
    S, anti = half(h, w, n, breaks, slope)
    row = S.col(0, "1", Y); out = {}
    u, P = S.initial.copy(), 0.0
    y, path = h, []
    for name, kind, g in guesses:                       # guesses are y/h of the apex, descending
        k = max(2, int(np.ceil((y / h - g) / 0.06)))
        for y in np.linspace(y, g * h, k + 1)[1:]: u, P, dP = S.solve_at(u, P, row, y)
        st = {"u": u, "P": P}
        def at(y):
            st["u"], st["P"], d = S.solve_at(st["u"], st["P"], row, y); return d
        if kind == "limit": f = at
        else:
            def f(y): at(y); return S.stiffness(st["u"], st["P"], anti, 6, (0, "1", TH, 1))
        ys = secant(f, y, y - 1e-3 * h, tol=1e-11)
        at(ys)
        z = st["u"][:-2].reshape(-1, 6)
        eps = (z[:, LAM]**2 - 1) / 2
        out[name] = (st["P"] * EI, ys, st["u"][-2] * EI, z[:, TH].max() - z[:, TH].min(), eps[np.abs(eps).argmax()])
        u, P, y = st["u"], st["P"], ys
    return out

SCAN = {0.02: [("upper limit", "limit", .53), ("lower limit", "limit", -.15)],
        0.03: [("bifurcation, upper", "anti", .775), ("upper limit", "limit", .625), ("lower limit", "limit", -.2), ("bifurcation, lower", "anti", -.35)]}
if __name__ == "__main__":
    for slope in ("direction", "vector"):
        for h, g in SCAN.items():
            a, b = run(h, slope, 12, B1, g), run(h, slope, 17, B2, g)
            print(f"h = {h}, slope = {slope}: load P [N] (two meshes), apex y [m] (two meshes), H [N], range of theta, largest strain")
            for k in a: print(f"  {k:20s} {a[k][0]:.11f} {b[k][0]:.11f}  rel {abs(a[k][0]/b[k][0]-1):.1e}   y {a[k][1]:.12f} {b[k][1]:.12f}  H {b[k][2]:.8f}  {b[k][3]:.5f} {b[k][4]:.4e}", flush=True)
