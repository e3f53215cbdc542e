"""Many inputs: one after the other, in processes of this machine, or on a Dask cluster; and the record of what came."""
