"""A parallel matrix with room for what cells will add to it."""

import numpy as np
from mpi4py import MPI
from numpy.typing import NDArray
from petsc4py import PETSc


def empty_matrix(numbers: NDArray[np.int32], first: int, last: int, comm: MPI.Comm) -> PETSc.Mat:
    """A matrix with two rows a node, and room for cells that couple all their nodes.

    Collective.

    Args:
        numbers: global numbers of the nodes of this rank's cells, (cells, nodes of a cell).
        first, last: the nodes that this rank owns, without the last.
        comm: communicator.
    """
    owned, width = last - first, 2 * numbers.shape[1]
    here = (first <= numbers) & (numbers < last)

    def brought(cells: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Entries that these cells bring to each row of the nodes owned here, at most."""
        nodes = numbers[cells][here[cells]] - first
        return width * np.bincount(nodes, minlength=owned)

    # Cells of other ranks bring entries to nodes on the border; without room for those PETSc would move
    # the whole matrix at each.
    border = PETSc.Vec().createMPI((owned, None), comm=comm)
    abroad = numbers[~here]
    border.setValues(abroad, np.full(len(abroad), float(width)), addv=PETSc.InsertMode.ADD_VALUES)
    border.assemble()
    from_others = border.array_r.astype(np.int64)
    border.destroy()
    within = np.maximum(brought(np.ones(len(numbers), dtype=bool)) + from_others, 2)  # a diagonal
    across = brought(np.any(~here, axis=1)) + from_others
    room = np.minimum(within, 2 * owned), np.minimum(across, 2 * comm.allreduce(owned))

    A = PETSc.Mat().create(comm)
    A.setSizes(((2 * owned, None), (2 * owned, None)), bsize=2)
    A.setType(PETSc.Mat.Type.AIJ)
    A.setPreallocationNNZ(tuple(np.repeat(entries, 2).astype(np.int32) for entries in room))
    # As PETSc does on ranks that have rows; where ranks differ, the assembly waits for ever.
    A.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, True)
    return A
