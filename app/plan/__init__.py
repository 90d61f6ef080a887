"""What a scene needs: states, tasks, sizes and cost, decided before any work is done."""
