"""A library of meshes mapped by one command: `holomorph batch SOURCE... --out DIR`. See docs/batch.md.

sources, blend : what there is to map         recipe : what is wanted of each asset
mapping, picture : one asset's maps, picture     task : all of it, in one process
journal : results, whole or not at all        worker, workers : processes that may fail, and what watches them
cluster : the same on Dask                    overview : index.html and the summaries     command : the command line
"""
