//! An order of elimination for any graph.

use super::etree::{elimination_tree, postorder};
use super::ordering::minimum_degree;

/// The nodes of a symmetric graph, given as compressed rows of neighbours without themselves, in an order to eliminate
/// them: approximate minimum degree (Amestoy et al. 1996) in postorder; their own order where the graph is beyond
/// faer's index type.
pub(crate) fn elimination_order(offsets: &[u32], neighbours: &[u32]) -> Vec<u32> {
    let count = offsets.len() - 1;
    let around = |node: usize| &neighbours[offsets[node] as usize..offsets[node + 1] as usize];
    let (mut upper_offsets, mut upper) = (vec![0], Vec::with_capacity(neighbours.len() / 2));
    for node in 0..count {
        upper.extend(around(node).iter().filter(|&&other| (other as usize) < node));
        upper_offsets.push(upper.len() as u32);
    }
    let rank = minimum_degree(count, &upper_offsets, &upper).unwrap_or_else(|| (0..count as u32).collect());
    let mut order = vec![0; count];
    for (node, &rank) in rank.iter().enumerate() {
        order[rank as usize] = node as u32;
    }
    let parent = elimination_tree(count, |column, sink| {
        for &other in around(order[column as usize] as usize) {
            sink(rank[other as usize]);
        }
    });
    postorder(&parent)
        .into_iter()
        .map(|column| order[column as usize])
        .collect()
}
