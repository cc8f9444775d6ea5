from paper.figures.claims_of import NUMBERS


def paper_figures(ending):
    """Files of the paper's figures by the ending of their names."""
    return [f"results/{{case}}/paper_figures/fig{number:02d}.{ending}" for number in NUMBERS]
