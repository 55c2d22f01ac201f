"""The parts of the validation, in the order of the report.

A part is a module with NAME (of --only), jobs(quick), the runs it needs, and evaluate(results,
quick), which makes a section of the report of those that succeeded. followups(results, quick),
where there is one, names runs that depend on the results of the first ones.
"""
