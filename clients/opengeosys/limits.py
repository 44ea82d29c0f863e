# SPDX-License-Identifier: MIT
"""Flow through a face whose pressure has a limit: rain that runs off, a seepage face. Water leaves where the pressure
passes its limit, and water outside holds it: a conductance takes the place of a switch between two conditions."""
from cases import value

LEAK = 1.0e-3  # [m/s] per kPa: a rain of 1e-5 m/s passes its limit by 0.01 kPa
# Of a quadratic edge: places and weights of Gauss, as OpenGeoSys takes them at order 4.
GAUSS = [(-0.8611363115940526, 0.3478548451374538), (-0.3399810435848563, 0.6521451548625461),
         (0.3399810435848563, 0.6521451548625461), (0.8611363115940526, 0.3478548451374538)]


def inflow(given, outside, where, t, x, y, pressure):
    """Flow in [m/s] and its derivative. given: without the limit; outside: pressure of the water in front [kPa]."""
    water = value(outside, t=t, x=x, y=y, **where)
    over = pressure - max(water, 0.0)
    open_ = over > 0 or water > 0
    return value(given, t=t, x=x, y=y, **where) - LEAK*over*open_, [-LEAK*open_]


def outflow(case, read, t, pressure):
    """Of a boundary [m2/s]."""
    (kind, what), = [(kind, what) for on, kind, what in case.conditions("inflow_w", "seepage") if on == read["on"]]
    given, outside = (what, 0.0) if kind == "inflow_w" else (0.0, what)
    total = 0.0
    for edge in case.edges[read["on"]]:
        (x1, y1), (x2, y2) = (case.places[n] for n in edge[:2])
        length = ((x2 - x1)**2 + (y2 - y1)**2)**0.5
        for s, weight in GAUSS:
            shapes = ((1 - s)/2, (1 + s)/2) if case.linear() else (s*(s - 1)/2, s*(s + 1)/2, 1 - s*s)
            x, y = (sum(n*case.places[i][k] for n, i in zip(shapes, edge)) for k in (0, 1))
            p = sum(n*pressure[i] for n, i in zip(shapes, edge))
            total -= weight*length/2*inflow(given, outside, read.get("where", {}), t, x, y, p)[0]
    return total
