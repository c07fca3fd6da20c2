"""The sources of the plugin meniscus_paraview.py."""
