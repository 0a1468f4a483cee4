"""The phantom library: one module a phantom, its parameters, its document and its sources."""
