"""Pictures of an archive or a scene: figures and films of states, friction loops, motions in time and
meshes."""
