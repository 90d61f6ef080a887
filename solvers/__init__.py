"""The mechanics: materials, friction laws, integral equations and finite elements."""
