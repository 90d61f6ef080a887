"""Contacts: ends, pressure, stresses and their extremes, and their solutions without a mesh."""

#: Words of a scene's output.quantities: intensities and the pressure's ends, stresses on the surface and
#: inside, yield, stresses along interfaces.
INTENSITIES, ON_SURFACE, BELOW, YIELD, AT_INTERFACES = "sif", "surface", "interior", "yield", "interfaces"

#: Modes of a prescribed pressure of the user's own, and of a punch whose contact has free ends.
OWN_PRESSURE, FREE_ENDS = "own pressure", "found ends"
#: Mode of a punch whose friction varies along the contact.
VARYING, VARYING_FREE = "friction along the contact", "friction along a contact with free ends"

#: Methods: closed form, singular integral equation of layers, finite elements.
CLOSED_FORM, SIE, FEM = "closed_form", "sie", "fem"
