"""Critical loads of straight columns: closed form, its check by a power-series shooting with 40 digits, and the values that
cubic Hermite elements must give.  Energy: integral of EA/2 eps^2 + EI/2 r''.r'', eps = (r'.r' - 1)/2."""
from mpmath import mp, mpf, pi, sqrt, matrix, det, findroot, cos, sin, tan
import numpy as np, scipy.linalg as sl
mp.dps = 40

CASES = {  # beta, rows of (w, w', w'', shear) at both ends, in the state vector (w, w', w'', w''')
    "clamped-free": pi / 2, "pinned-pinned": pi, "clamped-clamped": 2 * pi,
    "clamped-pinned": findroot(lambda x: sin(x) - x * cos(x), mpf("4.4934")), "clamped-guided": pi,
}
ENDS = {"clamped": lambda c: [[1, 0, 0, 0], [0, 1, 0, 0]], "pinned": lambda c: [[1, 0, 0, 0], [0, 0, 1, 0]],
        "free": lambda c: [[0, 0, 1, 0], [0, c, 0, 1]], "guided": lambda c: [[0, 1, 0, 0], [0, c, 0, 1]]}

def closed(beta, EI, EA, L):
    Pe = beta**2 * EI / L**2
    return Pe, sqrt(1 - 2 * Pe / EA), Pe * sqrt(1 - 2 * Pe / EA)

def stretch(P, EA):
    """root of EA Lambda (1 - Lambda^2)/2 = P on the branch from 1 (Newton, no closed form used)"""
    return findroot(lambda l: EA * l * (1 - l * l) / 2 - P, 1 - P / EA)

def shoot(P, EI, EA, L, name):
    """determinant of the boundary conditions; the transverse equation EI w'''' + c EI w'' = 0 by its Taylor series"""
    c = P / (stretch(P, EA) * EI)
    a, b = name.split("-")
    T = matrix(4, 4)
    for j in range(4):
        y = [mpf(0)] * 200
        y[j] = mpf(1)                                   # derivatives at s = 0
        for k in range(4, 200): y[k] = -c * y[k - 2]
        for i in range(4): T[i, j] = sum(y[i + k] * L**k / mp.factorial(k) for k in range(190))
    R = [list(map(mpf, r)) for r in ENDS[a](c)]
    B = matrix([list(map(mpf, r)) for r in ENDS[b](c)]) * T
    return det(matrix(R + B.tolist()))

def hermite(name, n):
    """smallest eigenvalue c L^2 of cubic Hermite elements, on the unit length"""
    h = 1.0 / n
    ke = np.array([[12, 6*h, -12, 6*h], [6*h, 4*h*h, -6*h, 2*h*h], [-12, -6*h, 12, -6*h], [6*h, 2*h*h, -6*h, 4*h*h]]) / h**3
    ge = np.array([[36, 3*h, -36, 3*h], [3*h, 4*h*h, -3*h, -h*h], [-36, -3*h, 36, -3*h], [3*h, -h*h, -3*h, 4*h*h]]) / (30 * h)
    K = np.zeros((2*n+2,)*2); G = K.copy()
    for e in range(n):
        K[2*e:2*e+4, 2*e:2*e+4] += ke; G[2*e:2*e+4, 2*e:2*e+4] += ge
    held = {"clamped": [0, 1], "pinned": [0], "free": [], "guided": [1]}
    a, b = name.split("-")
    free = sorted(set(range(2*n+2)) - set(held[a]) - {2*n+i for i in held[b]})
    mu = sl.eigh(G[np.ix_(free, free)], K[np.ix_(free, free)], eigvals_only=True)
    return 1 / mu.max()

if __name__ == "__main__":
    E, L = mpf("210e9"), mpf(1)
    for w in (mpf(1) / 10, mpf(1) / 100):
        A, I = w**2, w**4 / 12
        EA, EI = E * A, E * I
        print(f"\nw = {mp.nstr(w, 3)} m, EA = {mp.nstr(EA, 12)} N, EI = {mp.nstr(EI, 12)} N m2")
        for name, beta in CASES.items():
            Pe, lam, Pc = closed(beta, EI, EA, L)
            root = findroot(lambda P: shoot(P, EI, EA, L, name), (Pc * mpf("0.999"), Pc * mpf("1.0005")), solver="secant", tol=1e-50)
            print(f"  {name:16s} beta {mp.nstr(beta, 16)}  P_E {mp.nstr(Pe, 16)}  Lambda {mp.nstr(lam, 16)}  P_c {mp.nstr(Pc, 16)}"
                  f"  shooting - closed, relative {mp.nstr((root - Pc) / Pc, 3)}"
                  f"  first correction alone {mp.nstr(Pe * (1 - Pe / EA), 16)}")
    print("\nHermite elements: eigenvalue c L^2 = P/Lambda L^2/EI, relative error, error / ((beta h)^4/720), order, P_c for w = 0.1, 0.01")
    for name, beta in CASES.items():
        old = None
        for n in (1, 2, 4, 8, 16, 32):
            try: mu = hermite(name, n)
            except ValueError: print(f"  {name:16s} {n:3d} no unknowns"); continue
            if not np.isfinite(mu): continue
            err = mu / float(beta)**2 - 1
            Ps = [mu * 210e9 * w**4/12 * np.sqrt(1 - 2 * mu * w**2/12) if 2*mu*w*w/12 < 1 else float("nan") for w in (0.1, 0.01)]
            print(f"  {name:16s} {n:3d} {mu:.12f} {err:.4e} {err * 720 / (float(beta)/n)**4:.4f} {np.log2(old/err) if old else float('nan'):.3f} {Ps[0]:.6f} {Ps[1]:.10f}")
            old = err
