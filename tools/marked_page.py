"""Tables between marks of a page: what the tools write anew, the text around them stays."""


def replaced(text, mark, table):
    """`text` with what stands between <!-- mark --> and <!-- end --> exchanged."""
    head, rest = text.split(f"<!-- {mark} -->", 1)
    return f"{head}<!-- {mark} -->\n\n{table}\n\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
