"""Figures 4 to 8 of schlick1994, drawn again from what the library derives, with what the paper did not show.

`python -m paper_figures` makes them all. A figure is a file with three functions: `data()` computes what is drawn,
`draw(data, width)` draws it, `caption(data)` says what is to be seen, with the numbers found.
"""
