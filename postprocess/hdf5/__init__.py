"""HDF5 files: result archives and fields for ParaView, the one room that meets h5py."""
