"""From nodal forces and displacements to what users ask for: intensities, stresses, files, figures."""
