"""Eigenvalues of a scene with every kind of input, to some 40 digits, and their differences by each number.

The energies of `docs/conventions.md`, coded separately: integrals over Gauss points of each segment, trial
functions whose second derivatives are Legendre polynomials on each segment, and whole numbers as arithmetic
(`fixed`).  The scene's numbers are exact here and change by 1e-18 of their size, which no scene of 16 digits
can: differences to one side thus have 15 digits and more at any value, also at 0.  Nothing is shared with
`beamdyn` but the scene.

`numbers` makes a scene nondimensional, `mesh` has the trial functions, `energies` the forms, `eigenvalues`
solves, `differences` changes the numbers.
"""
