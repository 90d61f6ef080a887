"""Plans of scenes: states, tasks, sizes and cost, decided before any work is done."""
