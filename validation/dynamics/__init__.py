"""Speed against error: our integrator beside general ones, on the same equations."""
