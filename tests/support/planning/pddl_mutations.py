"""Spoils PDDL texts for the fuzz tests: by tokens, which mostly breaks them, and by branches, which often does not."""

import copy

# fmt: off
WORDS = [
    "(", ")", "and", "or", "not", "when", "forall", "exists", "-", "=", "?x", "?duration", "at", "start", "end", "over",
    "all", "1", "-1", "1e9", "0", "object", "either", ":init", ":goal", ":effect", ":condition", "p1", "table1", "a",
    "b",
]
CONNECTIVES = {
    "and", "or", "not", "when", "forall", "exists", "imply", "at", "over", "start", "end", "all", "=", "-",
}
# fmt: on


def tokens_of(text):
    """Words and parentheses, without comments."""
    text = "\n".join(line.partition(";")[0] for line in text.splitlines())
    return text.replace("(", " ( ").replace(")", " ) ").split()


def mutated(text, rng):
    """The text with a few of its tokens dropped, doubled, swapped or replaced."""
    tokens = tokens_of(text)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        i, j = rng.randrange(len(tokens)), rng.randrange(len(tokens))
        match rng.randrange(6):
            case 0 if len(tokens) > 2:
                del tokens[i]
            case 1:
                tokens.insert(i, tokens[j])
            case 2:
                tokens[i], tokens[j] = tokens[j], tokens[i]
            case 3:
                tokens[i] = rng.choice(WORDS)
            case 4:
                tokens[i] = tokens[i][::-1] + chr(rng.randrange(1, 0x3000))
            case _:
                tokens[i:i] = tokens[j : j + rng.randrange(12)]
    return " ".join(tokens)


def tree_of(text):
    """The text as nested lists of words."""
    stack = [[]]
    for token in tokens_of(text):
        if token == "(":
            stack.append([])
        elif token == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(token)
    return stack[0][0]


def text_of(node):
    return node if isinstance(node, str) else f"({' '.join(map(text_of, node))})"


def places(node):
    """Every (list, index) below a node."""
    for index, part in enumerate(node):
        yield node, index
        if isinstance(part, list):
            yield from places(part)


def kind(node, index):
    """What a branch or word may be swapped with and still make sense, now and then."""
    part = node[index]
    if isinstance(part, list):
        head = part[0] if part and isinstance(part[0], str) else ""
        return head if head in CONNECTIVES or head.startswith(":") else len(part)
    return (index == 0, part[0] if part[0] in "?:" else "", part if part in CONNECTIVES else "", part.isdecimal())


def regrown(text, rng):
    """The text with a few of its branches and words dropped, doubled, swapped or negated: it stays balanced."""
    tree = tree_of(text)
    for _ in range(rng.choice((1, 1, 2, 3))):
        spots = [(node, index) for node, index in places(tree) if node is not tree or index > 1]
        (node, index), wild = rng.choice(spots), rng.random() < 0.1
        donor, at = rng.choice([spot for spot in spots if wild or kind(*spot) == kind(node, index)])
        match rng.randrange(6):
            case 0:
                del node[index]
            case 1:
                node.insert(index, copy.deepcopy(donor[at]))
            case 2 if isinstance(node[index], list):
                node[index] = ["not", node[index]]
            case _:
                node[index] = copy.deepcopy(donor[at])
    return text_of(tree)
