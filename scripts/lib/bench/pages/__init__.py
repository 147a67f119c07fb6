"""The measured pages. Each module has

- SETTINGS: how much is measured, as name: (value, value of --quick); each is an option of the command line,
- measure(run): the numbers, as rows of a table, their conditions, and what else the page needs. Renders,
  which cannot be drawn again from numbers, may be drawn here,
- CSV: the file of the rows; everything else is kept as JSON,
- PAGES: the files of docs/results and their templates (page.py),
- values(found): the fields of the templates besides the conditions, from the numbers alone,
- draw(output, found): charts of the numbers, if there are any.
"""
