"""Frequencies of a rotating beam that bends in two planes, with twist and shear, by an independent method.

The differential equations in first-order form, solved by Gauss collocation; nothing is shared with
`beamdyn`. All quantities are nondimensional: length 1, and for example mass per length and bending
stiffness 1 at the root; ``gamma`` is the speed, ``lambda`` the frequency, ``hub`` the hub radius, positive
outward (-cos(phi) r/L for any setting angle).

Kinematics.  The centre line moves by u = (u2, u3) along b2 (in the plane of rotation) and b3 (the axis of
rotation) and does not stretch, so that its points move inward by 1/2 int |u'|^2.  Sections turn by p = (p2,
p3), the slopes of their normals; u' - p is shear.  The beam does not twist about its own line: the triads
of the sections are carried along without torsion.  To second order this turns a section about the beam axis
by

    tau(x) = 1/2 int_0^x (p2 p3' - p3 p2') dx      (tau(0) = 0: the root turns by the shortest rotation).

Energy of steady rotation.  For a section with the second moments of mass E22, E23, E33 (E23 = int y z dm),
-1/2 gamma^2 int (X1^2 + X2^2) dm is to second order, beyond the motion of its centre,

    1/2 gamma^2 (-E33 p3^2 - E23 p2 p3 + 2 E23 tau).

The last term, integrated by parts, is 1/2 gamma^2 int G (p2 p3' - p3 p2') dx, where G(x) is the integral of
E23 over all that lies outboard, the tip body included.  That body, with moments of inertia J11, J33 about
b1, b3, gives about its centre of gravity

    1/2 gamma^2 ((J33 - J11) p3^2 - E23 p2 p3 + 2 E23 tau(1)),

and as a section has J33 - J11 = -E33, this is one formula.  In one plane p = e1 q' it is (J_e - J_1) sin^2
psi q'^2, as E23 = (J_n - J_e) cos psi sin psi, and tau = 0.

There is no gyroscopic coupling: half a turn about the beam axis changes the signs of the deflection, of the
speed, and of the distance by which the axis of rotation passes beside the beam.  A term of the energy that
is linear in the speed and bilinear in deflection and velocity is hence linear in that distance, and then it
only contains the inward motion's rate, a derivative in time.

Equations.  With K, S, E the matrices of bending stiffness, shear stiffness and rotary inertia in b2, b3
(turned by psi), W the symmetric matrix of -E33 p3^2 - E23 p2 p3, J p = (-p3, p2), P u = (u2, 0), z =
lambda^2, V the section's shear force, N = gamma^2 (int_x^1 m (hub + s) ds + m_t (hub + 1 + eps)) the
tension, which acts on u' (Engesser):

    u' = p + V / S,      V + N u' = Q,       K p' = M - 1/2 gamma^2 G J p,
    M' = -V + gamma^2 (W p + 1/2 G J^T p') - z E p,       Q' = -gamma^2 m P u - z m u;
    root   u = 0, and along e1 and e2 at the root  M = k p,  or p = 0 where k is infinite;
    tip    with t = u + eps p:   Q = m_t (z + gamma^2 P) t,
           M + gamma^2 (W_t + m_t (hub + 1 + eps) eps) p = z J_t p + eps m_t (z + gamma^2 P) t.

u, p, M and Q are continuous where properties jump.  With one plane, u = e1 q everywhere, and the same
equations are taken along e1.

Check (tests/invariants/test_second_method.py, tests/literature/test_two_planes.py).  The energy of rotation
agrees with that of triads integrated at finite amplitude.  Each eigenvalue agrees with the quotient of the
energies of its mode to 1e-11.  All rows of beamdyn/published/twisted_beams.toml and blades.toml agree to
every digit given there: those of two planes to 2e-14, those of shear and rotary inertia to 4e-10 or half a
unit of the last digit; Carnegie's blade and the three blades of wind turbines likewise.

``python -m benchmarks.cases.reference.twisted_beam`` writes data/second_method.toml, see `cases`.
"""

from benchmarks.cases.reference.twisted_beam.blade import Blade, Body, constant
from benchmarks.cases.reference.twisted_beam.collocation import Solution, converged, solve

__all__ = ["Blade", "Body", "Solution", "constant", "converged", "solve"]
